#pragma once

#include "grids/moved_field.h"
#include "prepare/prepared_scene.h"

#include <optional>

namespace vdbeam {

// Functions that take a StopToken read files and make fields, and throw Stopped when it says so.

/// The part of a volume's file that can become visible in its box; none: all of it. `motion`: what
/// moves it, or null.
std::optional<WantedBox> wanted_box(const VolumeSettings& volume, const Motion* motion);

/// Keeps the grids of a volume's file that its `moments` will move or edit, each in its own way, so
/// that they need not read them. Its velocity must be known.
void keep_sources(const VolumeSettings& volume, const std::vector<VolumeSettings>& moments,
                  const PreparedScenePtr& previous, const StopToken& stop, ReadVolume& read);

/// Everything that decides a volume's density and colours: volumes with the same share them.
std::string density_identity(const VolumeSettings& volume);
/// The same of its emission field, whose strength does not count.
std::string emission_identity(const VolumeSettings& volume);

/// A volume's density as the scene wants it: read, or taken from `previous`, moved and edited.
DensityGrid take_grid(const VolumeSettings& volume, const PreparedScenePtr& previous,
                      const StopToken& stop, ReadVolume& read);

/// Reads the emission of volumes; `earlier`: the volumes of this scene that were read before it.
EmissionGrid take_emission(const VolumeSettings& volume, const PreparedScenePtr& previous,
                           const std::vector<ReadVolume>& earlier, const StopToken& stop,
                           ReadVolume& read);
/// Whether a volume is read as it stands in its file, not moved to another moment.
bool stands_still(const VolumeSettings& volume, const ReadVolume& read);

/// Gives the density the colours of the volume's color_grid, moved like it.
void take_colors(const VolumeSettings& volume, const PreparedScenePtr& previous,
                 const StopToken& stop, ReadVolume& read, DensityGrid& grid);

/// Reads the velocity of a volume that passes see at several moments, or takes it from `previous`.
void take_velocity(const Scene& scene, std::size_t volume, const PreparedScenePtr& previous,
                   const StopToken& stop, ReadVolume& read);
/// Notes what is wrong with velocities.
void note_velocities(const Scene& scene, PreparedScene& prepared);

} // namespace vdbeam
