#pragma once

#include "lights/cone.h"
#include "transport/world.h"

#include <functional>

namespace vdbeam {

/// What photons are aimed at (AimedLight) in a scene with surfaces: the medium first, then the
/// surfaces within boxes about it, each four times as wide as the one before, at last all of them.
/// Only the latter where there is no medium.
std::vector<OccupiedRegion> photon_targets(const OccupiedRegion& medium,
                                           const SurfaceSet& surfaces);

/// Whether a photon counts: the first of the world's targets that its ray meets is one of its own.
bool counts_for_its_target(const World& world, const EmittedPhoton& photon);

/// Where the flight of a photon begins: at the edge of the region that it is aimed at, or, where a
/// surface stands before that, at its light, or before everything if the light is far away.
Vec3d beginning_of_flight(const World& world, const Light& light, const EmittedPhoton& photon);

/// The cone about the medium's sphere as seen from a point; none where the point lies in the
/// sphere.
std::optional<Cone> cone_to_medium(const World& world, const Vec3d& point);

/// Copies of a light path that a surface sends into the cone of the medium.
struct CopiesToMedium {
  static constexpr int most = 8;

  int count = 0;
  float solid_angle = 0; ///< that each of them stands for
};

/// As many copies as give each about the flux that photons bring to the medium straight from their
/// light; `flux`: of the path, in units of that. Where that is less than one copy, there is one by
/// chance, which stands for the others.
CopiesToMedium copies_to_medium(const SurfaceVertex& vertex, const Cone& cone, float flux,
                                Rng& rng);

/// Adds the scene's lights, aimed at each of the world's targets. Throws as LightSet does.
void add_aimed_lights(const std::vector<LightSettings>& settings, const Vec3d& up,
                      std::vector<std::string>& notes, World& world);

/// The light of a surface that shines, aimed at the medium and at the rest; `make(medium)` makes
/// it, aimed at a region or, where that is null, at all that it shines on.
std::unique_ptr<Light>
aim_surface_light(const World& world,
                  const std::function<std::unique_ptr<Light>(const OccupiedRegion*)>& make);

} // namespace vdbeam
