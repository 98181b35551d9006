#pragma once

#include "transport/world.h"

namespace vdbeam {

/// What photons are aimed at (AimedLight) in a scene with surfaces: the medium first, then the
/// surfaces within boxes about it, each four times as wide as the one before, at last all of them.
/// Only the latter where there is no medium.
std::vector<OccupiedRegion> photon_targets(const OccupiedRegion& medium,
                                           const SurfaceSet& surfaces);

/// Whether a photon counts: the first of the world's targets that its ray meets is one of its own.
bool counts_for_its_target(const World& world, const EmittedPhoton& photon);

/// Adds the scene's lights, aimed at each of the world's targets. Throws as LightSet does.
void add_aimed_lights(const std::vector<LightSettings>& settings, const Vec3d& up,
                      std::vector<std::string>& notes, World& world);

/// The light of a surface that shines, aimed at the medium and at the rest; `make(medium)` makes
/// it, aimed at a region or, where that is null, at all that it shines on.
std::unique_ptr<Light>
aim_surface_light(const World& world,
                  const std::function<std::unique_ptr<Light>(const OccupiedRegion*)>& make);

} // namespace vdbeam
