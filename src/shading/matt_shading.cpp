#include "shading/matt_shading.h"

#include "math/mean_of_light.h"

namespace vdbeam {

namespace {

/// Paths where the surface is not only matt, which show how much the light of the rest varies; and
/// where the light is not fitted over pixels.
constexpr int fewest_of_gloss = 2, paths_if_alone = 4;

/// The mean of two means, by the numbers of their samples.
void join(GroupedLight& mean, int count, const GroupedLight& other, int others) {
  mean *= static_cast<float>(count) / static_cast<float>(count + others);
  mean += other * (static_cast<float>(others) / static_cast<float>(count + others));
}

} // namespace

bool shows_light(const Rgb& color) {
  constexpr float least = 1e-3f;
  return std::min(color.x, std::min(color.y, color.z)) > least;
}

void locate(const SurfaceVertex& vertex, SeenSurface& seen) {
  seen.position = Vec3f(vertex.hit().position);
  seen.normal = vertex.hit().shading_normal * (vertex.front() ? 1.0f : -1.0f);
  seen.surface = vertex.hit().surface;
}

/// Samples of a surface's light.
struct MattShading::Sum {
  explicit Sum(const SurfaceVertex& vertex)
      : has_matt(shows_light(vertex.matt_albedo())),
        has_gloss(!has_matt || !vertex.material().is_all_matt()) {}

  bool has_matt, has_gloss; ///< without matt light all counts as glossy
  GroupedLight smooth;      ///< the sum of what comes by way of other surfaces
  MeanOfLight straight, gloss;

  void add(const ReflectedLight& light) {
    const GroupedLight rest = light.straight.gloss + light.beyond.gloss;
    if (has_matt)
      smooth += light.beyond.matt;
    straight.add(has_matt ? light.straight.matt : GroupedLight());
    gloss.add(has_matt ? rest : rest + light.straight.matt + light.beyond.matt);
  }
};

MattShading::MattShading(const World& world, const PhotonPlan& plan,
                         const SurfaceLighting& surfaces)
    : world_(world), plan_(plan), surfaces_(surfaces),
      extended_(samples_extended_light(
          world, [&](std::size_t i) { return surfaces.tracer().samples_light(i); })) {}

/// Each path brings a sample of the shadow rays' light, too.
void MattShading::sample(const SurfaceVertex& vertex, const MattSamples& samples, Rng& rng,
                         Sum& sum) const {
  for (int i = 0; i < samples.paths; ++i)
    sum.add(surfaces_.by_paths(vertex, rng));
  for (int i = samples.paths; i < samples.shadow_rays; ++i) {
    GroupedLight matt;
    surfaces_.tracer().lights_at_surface(vertex, rng, true, false, &matt);
    sum.straight.add(matt * vertex.absorbed());
  }
}

/// Samples of a surface, before its pixel's neighbours ask for more.
MattSamples MattShading::fewest(const Sum& sum, bool is_fitted) const {
  MattSamples samples = MattSamples::fewest();
  if (sum.has_gloss)
    samples.paths = is_fitted ? fewest_of_gloss : paths_if_alone;
  samples.shadow_rays = std::max(samples.paths, extended_ ? samples.shadow_rays : 1);
  return samples;
}

SeenSurface MattShading::seen(const SurfaceVertex& vertex, const RngKey& key,
                              std::size_t stream) const {
  Sum sum(vertex);
  SeenSurface seen{.lamp = lamp_of(vertex)};
  seen.albedo = sum.has_matt ? vertex.matt_albedo() : Rgb(1);
  seen.gloss_color = sum.has_matt ? Rgb(1) : vertex.texture();
  const bool is_fitted = shows_light(seen.gloss_color);
  const MattSamples samples = fewest(sum, is_fitted);
  Rng rng(key, RngStage::surface, stream);
  sample(vertex, samples, rng, sum);
  sum.smooth *= 1 / static_cast<float>(samples.paths);
  const GroupedLight straight = sum.straight.mean(), photons = surfaces_.by_photons(vertex, rng);
  const GroupedLight emitted(vertex.emitted(), group_of(world_, vertex));
  seen.radiance = sum.smooth + straight + photons + emitted;
  seen.smooth = sum.smooth / seen.albedo;
  seen.straight = straight / seen.albedo;
  if (samples.shadow_rays > 1)
    seen.straight_variance = mean_component(sum.straight.variance() / (seen.albedo * seen.albedo));
  if (sum.has_gloss)
    seen.radiance += sum.gloss.mean();
  if (!is_fitted)
    return seen;
  if (sum.has_gloss) {
    seen.gloss = sum.gloss.mean() / seen.gloss_color;
    seen.gloss_variance =
        mean_component(sum.gloss.variance() / (seen.gloss_color * seen.gloss_color));
  }
  seen.samples = samples;
  locate(vertex, seen);
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
  Sum sum(vertex);
  sample(vertex, samples, rng, sum);
  const GroupedLight rest = seen.radiance - seen.fitted();
  if (samples.paths > 0) {
    const int before = seen.samples.paths;
    join(seen.smooth, before, sum.smooth * (1 / static_cast<float>(samples.paths)) / seen.albedo,
         samples.paths);
    join(seen.gloss, before, sum.gloss.mean() / seen.gloss_color, samples.paths);
    seen.samples.paths += samples.paths;
    // The variance of a sample stays as it was measured first.
    seen.gloss_variance *= static_cast<float>(before) / static_cast<float>(seen.samples.paths);
  }
  const int before = seen.samples.shadow_rays;
  join(seen.straight, before, sum.straight.mean() / seen.albedo, samples.shadow_rays);
  seen.samples.shadow_rays += samples.shadow_rays;
  seen.straight_variance *=
      static_cast<float>(before) / static_cast<float>(seen.samples.shadow_rays);
  seen.radiance = rest + seen.fitted();
}

/// Emission of the surface as a light with shadow rays into the medium.
GroupedLight MattShading::lamp_of(const SurfaceVertex& vertex) const {
  const int light = vertex.light();
  const bool sampled = light >= 0 && plan_.sampled_lights[static_cast<std::size_t>(light)];
  return {sampled ? vertex.emitted() : Rgb(), group_of(world_, vertex)};
}

} // namespace vdbeam
