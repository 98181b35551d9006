#pragma once

#include "render/prepared_scene.h"
#include "volume/moved_field.h"

#include <optional>

namespace vdbeam {

/// What of a volume's file can come to be seen through its box; none: all of it. `motion`: what
/// moves it, or null.
std::optional<WantedBox> wanted_box(const VolumeSettings& volume, const Motion* motion);

/// A volume's density as the scene wants it: read, or taken from `previous`, moved and edited.
DensityGrid take_grid(const VolumeSettings& volume, const PreparedScenePtr& previous,
                      ReadVolume& read);

/// Likewise what glows.
EmissionGrid take_emission(const VolumeSettings& volume, const PreparedScenePtr& previous,
                           ReadVolume& read);

/// Gives the density the colours of the volume's color_grid, moved like it.
void take_colors(const VolumeSettings& volume, const PreparedScenePtr& previous, ReadVolume& read,
                 DensityGrid& grid);

/// Reads the velocities of volumes that passes see at several moments.
void take_velocities(const Scene& scene, const PreparedScenePtr& previous, PreparedScene& prepared);

} // namespace vdbeam
