#include "shading/surface_lighting.h"

#include "photons/photon_plan.h"
#include "photons/surface_photons.h"

namespace vdbeam {

SurfaceLighting::SurfaceLighting(const EstimatorInput& input, const World& world,
                                 const PhotonMap* photons)
    : world_(world), photons_(photons),
      tracer_(world, lights_of_surfaces(input), input.settings.max_bounces) {}

GroupedLight SurfaceLighting::reflected(const SurfaceVertex& vertex, const Vec3f& direction,
                                        Rng& rng) const {
  return tracer_.from_surface(vertex.hit(), direction, rng, !shows_photons(vertex), false) +
         by_photons(vertex, rng);
}

ReflectedLight SurfaceLighting::by_paths(const SurfaceVertex& vertex, Rng& rng) const {
  return tracer_.reflected(vertex, rng, !shows_photons(vertex));
}

GroupedLight SurfaceLighting::added_to_plate(const SurfaceVertex& vertex, const Vec3f& direction,
                                             Rng& rng) const {
  constexpr int paths = 4;
  GroupedLight sum;
  for (int i = 0; i < paths; ++i)
    sum += tracer_.added_to_plate(vertex.hit(), direction, rng, !shows_photons(vertex));
  return sum / static_cast<float>(paths) + by_photons(vertex, rng);
}

GroupedLight SurfaceLighting::by_photons(const SurfaceVertex& vertex, Rng& rng) const {
  if (!shows_photons(vertex))
    return {};
  return SurfacePhotons(*world_.surfaces, *photons_).reflected(vertex, rng);
}

} // namespace vdbeam
