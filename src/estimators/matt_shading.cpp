#include "estimators/matt_shading.h"

#include "math/mean_of_light.h"

namespace vdbeam {

namespace {

/// Paths where the light is not fitted over pixels (SurfaceFit).
constexpr int paths_if_alone = 4;

bool samples_extended_light(const World& world, const WalkTracer& tracer) {
  for (std::size_t i = 0; i < world.lights.size(); ++i)
    if (tracer.samples_light(i) && !world.lights[i].is_delta())
      return true;
  return false;
}

/// The mean of two means, by the numbers of their samples.
void join(GroupedLight& mean, int count, const GroupedLight& other, int others) {
  mean *= static_cast<float>(count) / static_cast<float>(count + others);
  mean += other * (static_cast<float>(others) / static_cast<float>(count + others));
}

} // namespace

/// Samples so far, where they leave the surface.
struct MattShading::Sum {
  GroupedLight smooth;  ///< by way of other surfaces
  MeanOfLight straight; ///< from lights, by shadow rays
};

MattShading::MattShading(const World& world, const PhotonPlan& plan,
                         const SurfaceLighting& surfaces)
    : world_(world), plan_(plan), surfaces_(surfaces),
      extended_(samples_extended_light(world, surfaces.tracer())) {}

/// Each path brings a sample of the shadow rays' light, too.
void MattShading::sample(const SurfaceVertex& vertex, const Vec3f& direction,
                         const MattSamples& samples, Rng& rng, Sum& sum) const {
  for (int i = 0; i < samples.paths; ++i) {
    GroupedLight by_shadow_rays;
    sum.smooth += surfaces_.by_paths(vertex, direction, rng, &by_shadow_rays) - by_shadow_rays;
    sum.straight.add(by_shadow_rays);
  }
  for (int i = samples.paths; i < samples.shadow_rays; ++i)
    sum.straight.add(surfaces_.tracer().lights_at_surface(vertex, rng, true) * vertex.absorbed());
}

SeenSurface MattShading::seen(const SurfaceVertex& vertex, const Vec3f& direction,
                              const RngKey& key, std::size_t stream) const {
  const Rgb albedo = vertex.matt_albedo();
  // A channel that reflects nothing does not show what light there is.
  constexpr float least_albedo = 1e-3f;
  const bool fitted = std::min(albedo.x, std::min(albedo.y, albedo.z)) > least_albedo;
  MattSamples samples = MattSamples::fewest();
  if (!fitted)
    samples.paths = paths_if_alone;
  samples.shadow_rays = std::max(samples.paths, extended_ ? samples.shadow_rays : 1);
  Rng rng(key, RngStage::surface, stream);
  Sum sum;
  sample(vertex, direction, samples, rng, sum);
  sum.smooth *= 1 / static_cast<float>(samples.paths);
  const GroupedLight straight = sum.straight.mean(), photons = surfaces_.by_photons(vertex, rng);
  const GroupedLight emitted(vertex.emitted(), group_of(world_, vertex));
  SeenSurface seen{.radiance = sum.smooth + straight + photons + emitted, .lamp = lamp_of(vertex)};
  if (!fitted)
    return seen;
  seen.albedo = albedo;
  seen.smooth = sum.smooth / albedo;
  seen.straight = straight / albedo;
  if (samples.shadow_rays > 1)
    seen.straight_variance = mean_component(sum.straight.variance() / (albedo * albedo));
  seen.samples = samples;
  seen.position = Vec3f(vertex.hit().position);
  seen.normal = vertex.hit().shading_normal * (vertex.front() ? 1.0f : -1.0f);
  seen.surface = vertex.hit().surface;
  return seen;
}

void MattShading::add(const CameraRay& camera, const MattSamples& more, const RngKey& key,
                      std::size_t stream, SeenSurface& seen) const {
  MattSamples samples = more;
  samples.shadow_rays = std::max(samples.paths, extended_ ? samples.shadow_rays : 0);
  if (samples.shadow_rays == 0)
    return;
  const SurfaceVertex vertex(*world_.surfaces, *camera.hit, camera.ray().direction);
  Rng rng(key, RngStage::more_surface, stream);
  Sum sum;
  sample(vertex, camera.ray().direction, samples, rng, sum);
  const auto rest = seen.radiance - (seen.smooth + seen.straight) * seen.albedo;
  if (samples.paths > 0)
    join(seen.smooth, seen.samples.paths,
         sum.smooth * (1 / static_cast<float>(samples.paths)) / seen.albedo, samples.paths);
  const int before = seen.samples.shadow_rays;
  join(seen.straight, before, sum.straight.mean() / seen.albedo, samples.shadow_rays);
  seen.samples.paths += samples.paths;
  seen.samples.shadow_rays += samples.shadow_rays;
  // The variance of a sample stays as it was measured first.
  seen.straight_variance *=
      static_cast<float>(before) / static_cast<float>(seen.samples.shadow_rays);
  seen.radiance = rest + (seen.smooth + seen.straight) * seen.albedo;
}

/// Emission of the surface as a light with shadow rays into the medium.
GroupedLight MattShading::lamp_of(const SurfaceVertex& vertex) const {
  const int light = vertex.light();
  const bool sampled = light >= 0 && plan_.sampled_lights[static_cast<std::size_t>(light)];
  return {sampled ? vertex.emitted() : Rgb(), group_of(world_, vertex)};
}

} // namespace vdbeam
