#include "estimators/surface_shading.h"

#include "estimators/caught_shadow.h"
#include "estimators/direct_light.h"
#include "estimators/profile_shading.h"
#include "estimators/surface_photons.h"
#include "transport/emission.h"

#include <utility>

namespace vdbeam {

namespace {

/// Random paths that go on from each camera ray that ends at a surface.
constexpr int paths_per_ray = 4;
/// Weight under which Russian roulette begins.
constexpr float roulette_below = 0.1f;

/// The ray that leaves a surface, up to the next.
CameraRay next_ray(const World& world, const Vec3d& origin, const Vec3f& direction) {
  CameraRay ray;
  ray.segment.ray = {Vec3f(origin), direction};
  ray.hit =
      world.surfaces->set->intersect(origin, Vec3d(direction), 0, static_cast<double>(infinity));
  ray.segment.t_end = world.surfaces->medium_end(ray.hit, direction);
  if (world.medium.visible())
    ray.segment = world.medium.clip(ray.segment);
  else
    ray.segment.t_end = 0;
  return ray;
}

} // namespace

SurfaceShading::SurfaceShading(const EstimatorInput& input, const PhotonPass& photons,
                               GatherAlong gather)
    : world_(photons.world()), photons_(photons), gather_(std::move(gather)),
      tracer_(world_, lights_of_surfaces(input), input.settings.max_bounces),
      photons_on_surfaces_(input.plan.needs(Stage::surface_photons)),
      cutoff_(static_cast<float>(input.settings.cutoff)) {}

SeenSurface SurfaceShading::seen(const CameraRay& camera, const RngKey& key, std::size_t pixel,
                                 RenderStatistics& counts) const {
  if (!camera.hit)
    return {};
  if (world_.surfaces->material(*camera.hit).is_shadow_catcher()) {
    Rng rng(key, RngStage::surface, pixel * paths_per_ray);
    return {{}, caught_shadow(world_, camera, rng)};
  }
  const Vec3f& direction = camera.ray().direction;
  const SurfaceVertex vertex(*world_.surfaces, *camera.hit, direction);
  const bool by_photons = shows_photons(vertex);
  Rgb sum, photons;
  for (int i = 0; i < paths_per_ray; ++i) {
    Rng rng(key, RngStage::surface, pixel * paths_per_ray + static_cast<std::size_t>(i));
    if (!by_photons)
      sum += follow(*camera.hit, direction, rng, counts);
    else
      sum += tracer_.from_surface(*camera.hit, direction, rng, false);
    if (by_photons && i == 0) // the same for all
      photons = SurfacePhotons(*world_.surfaces, photons_.surface_map()).reflected(vertex, rng);
  }
  return {sum / static_cast<float>(paths_per_ray) + photons};
}

Rgb SurfaceShading::follow(SurfaceHit hit, Vec3f direction, Rng& rng,
                           RenderStatistics& counts) const {
  const Medium& medium = world_.medium;
  Rgb throughput(1), sum;
  float refraction = 1;
  SurfaceRoulette length;
  DepthProfile profile;
  for (;;) {
    const SurfaceVertex vertex(*world_.surfaces, hit, direction);
    if (!vertex.material().is_specular() || vertex.material().is_black()) {
      const bool by_photons = shows_photons(vertex);
      Rgb light = tracer_.from_surface(hit, direction, rng, !by_photons);
      if (by_photons)
        light += SurfacePhotons(*world_.surfaces, photons_.surface_map()).reflected(vertex, rng);
      return sum + light * throughput;
    }
    const MaterialSample next = vertex.sample(Carried::radiance, rng);
    throughput *= vertex.absorbed() * next.weight;
    refraction *= next.refraction;
    if (!survive_roulette(roulette_below * refraction, throughput, rng) ||
        !length.survive(throughput, rng))
      return sum;
    const CameraRay ray = next_ray(world_, hit.leave(next.wi), next.wi);
    profile.build(medium, ray.segment, cutoff_);
    const Rgb tr = transmittance(medium, profile);
    Rgb radiance = lights_through(world_, ray.whole(), profile, tr, false);
    if (!ray.segment.empty())
      radiance += emission_along(medium, ray.segment, profile, cutoff_);
    if (!profile.empty())
      radiance += in_scattered(ray, profile, rng, counts);
    sum += radiance * throughput;
    throughput *= tr;
    if (!ray.hit || !survive_roulette(roulette_below * refraction, throughput, rng))
      return sum;
    hit = *ray.hit;
    direction = next.wi;
  }
}

/// Light that the medium scatters into the ray: once, by shadow rays; else by photons.
Rgb SurfaceShading::in_scattered(const CameraRay& ray, const DepthProfile& profile, Rng& rng,
                                 RenderStatistics& counts) const {
  ++counts.depth_profiles;
  Rgb sum = direct_light(world_, ray.ray(), profile, photons_.plan().sampled_lights, 1, rng,
                         counts.shadow_rays, photons_.shadows());
  if (photons_.map().size() > 0) {
    ++counts.lookups;
    sum += gather_(ray, profile, rng);
  }
  return sum;
}

} // namespace vdbeam
