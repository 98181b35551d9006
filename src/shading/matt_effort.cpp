#include "shading/matt_effort.h"

#include "shading/surface_fit.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Pixels around one without which nothing is decided: fewer show no spread. Half of it and twice
/// change no error (docs/developer/tuning.md).
constexpr int fewest_around = 4;

/// Sums over the pixels around one.
struct Around {
  float count = 0, ray_variance = 0, gloss_variance = 0; ///< of one sample each
  Rgb light, glossy;                                     ///< all light, per colour of each part
  Rgb straight, straight_squares, smooth, smooth_squares, gloss, gloss_squares;

  void add(const SeenSurface& seen) {
    ++count;
    light += seen.radiance.sum() / seen.albedo;
    glossy += seen.radiance.sum() / seen.gloss_color;
    gloss_variance += seen.gloss_variance * static_cast<float>(seen.samples.paths);
    gloss += seen.gloss.sum();
    gloss_squares += seen.gloss.sum() * seen.gloss.sum();
    ray_variance += seen.straight_variance * static_cast<float>(seen.samples.shadow_rays);
    straight += seen.straight.sum();
    straight_squares += seen.straight.sum() * seen.straight.sum();
    smooth += seen.smooth.sum();
    smooth_squares += seen.smooth.sum() * seen.smooth.sum();
  }
  /// Variance of one of them, mean of channels.
  float spread(const Rgb& sum, const Rgb& squares) const {
    const Rgb mean = sum / count;
    return std::max(0.0f, mean_component(squares / count - mean * mean)) * count / (count - 1);
  }
};

Around around_ray(const TileSurfaces& seen, int ray) {
  Around sums;
  for_each_near(seen, ray, [&](int other) {
    if (other != ray)
      sums.add(seen[static_cast<std::size_t>(other)]);
  });
  return sums;
}

/// Samples in all, where one has this squared relative error.
int samples_for(float error, float error_of_one) {
  return static_cast<int>(std::lround(std::clamp(std::sqrt(error / error_of_one), 0.0f,
                                                 static_cast<float>(tuning::most_matt_samples))));
}

/// The part of a sample's variance that the fit will leave. `spread`: variance of means over
/// `samples` from pixel to pixel.
float left_by_fit(float variance, int samples, float spread, int passes, float tolerance) {
  const float plane =
      SurfaceFit::best_weight(variance / static_cast<float>(samples), spread, passes, tolerance);
  return variance * ((1 - plane) * (1 - plane) + plane * plane * tuning::left_by_plane);
}

/// Samples of a pixel with this light around that has `so_far`; `tr`: what of it reaches the
/// camera.
MattSamples wanted_samples(const Around& near, const MattSamples& so_far, float tr, int passes) {
  const float mean = mean_component(near.light) / near.count,
              per_gloss = mean_component(near.glossy) / near.count;
  if (!(mean > 0 && per_gloss > 0))
    return {};
  const float relative = tr * tr / (mean * mean);
  const float of_ray = left_by_fit(near.ray_variance / near.count, so_far.shadow_rays,
                                   near.spread(near.straight, near.straight_squares), passes, 1) *
                       relative;
  const float of_gloss =
      left_by_fit(near.gloss_variance / near.count, so_far.paths,
                  near.spread(near.gloss, near.gloss_squares), passes, tuning::gloss_tolerance) *
      tr * tr / (per_gloss * per_gloss);
  const float of_smooth =
      near.spread(near.smooth, near.smooth_squares) * tuning::left_by_plane * relative;
  return {samples_for(of_smooth + of_gloss, tuning::error_of_matt_light),
          samples_for(of_ray, tuning::error_of_matt_light)};
}

} // namespace

std::array<MattSamples, TileRays::count> more_samples(const Medium& medium, const TileRays& rays,
                                                      const TileSurfaces& seen, int passes) {
  std::array<MattSamples, TileRays::count> more;
  for (std::size_t i = 0; i < more.size(); ++i) {
    const TileRays::PixelRay& ray = rays[static_cast<int>(i)];
    if (!ray.inside || seen[i].surface < 0 || seen[i].samples.paths == 0)
      continue;
    const Around near = around_ray(seen, static_cast<int>(i));
    if (near.count < fewest_around)
      continue;
    const MattSamples& has = seen[i].samples;
    const float tr = mean_component(transmittance(medium, ray.profile));
    const MattSamples wanted = wanted_samples(near, has, tr, passes);
    more[i] = {std::max(0, wanted.paths - has.paths),
               std::max(0, wanted.shadow_rays - has.shadow_rays)};
  }
  return more;
}

} // namespace vdbeam
