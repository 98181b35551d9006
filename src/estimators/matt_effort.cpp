#include "estimators/matt_effort.h"

#include "estimators/surface_fit.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Pixels to each side that decide, and how many of them there must be.
constexpr int around = 2, fewest_around = 4;
constexpr int width = PassImage::tile_width;

/// Sums over the pixels around one.
struct Around {
  float count = 0, ray_variance = 0;
  Rgb light, straight, straight_squares, smooth, smooth_squares;

  void add(const SeenSurface& seen) {
    ++count;
    light += seen.radiance.sum() / seen.albedo;
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

/// The surfaces of a tile by their pixels.
class Pixels {
public:
  Pixels(const TileRays& rays, const TileSurfaces& seen, int image_width)
      : rays_(rays), image_width_(static_cast<std::size_t>(image_width)) {
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (rays[static_cast<int>(i)].inside && seen[i].surface >= 0)
        pixels_[index(i)] = &seen[i];
  }

  Around around_ray(std::size_t ray) const {
    Around sums;
    const std::size_t center = index(ray);
    const int x = static_cast<int>(center) % width, y = static_cast<int>(center) / width;
    for (int py = std::max(0, y - around); py <= std::min(width - 1, y + around); ++py)
      for (int px = std::max(0, x - around); px <= std::min(width - 1, x + around); ++px) {
        const auto other = static_cast<std::size_t>(py * width + px);
        if (other != center && pixels_[other] &&
            pixels_[other]->surface == pixels_[center]->surface)
          sums.add(*pixels_[other]);
      }
    return sums;
  }

private:
  std::size_t index(std::size_t ray) const {
    const std::size_t pixel = rays_[static_cast<int>(ray)].pixel;
    return (pixel / image_width_ - static_cast<std::size_t>(rays_.y0())) * width +
           pixel % image_width_ - static_cast<std::size_t>(rays_.x0());
  }

  const TileRays& rays_;
  std::size_t image_width_;
  std::array<const SeenSurface*, TileRays::count> pixels_{};
};

/// Samples in all, where one has this squared relative error.
int samples_for(float error, float error_of_one) {
  return static_cast<int>(std::lround(std::clamp(std::sqrt(error / error_of_one), 0.0f,
                                                 static_cast<float>(tuning::most_matt_samples))));
}

/// Samples of a pixel with this light around; `tr`: what of it reaches the camera.
MattSamples wanted_samples(const Around& near, int rays_so_far, float tr, int pass) {
  const float mean = mean_component(near.light) / near.count;
  if (!(mean > 0))
    return {};
  const float relative = tr * tr / (mean * mean);
  const float variance = near.ray_variance / near.count;
  const float plane =
      SurfaceFit::best_weight(variance / static_cast<float>(rays_so_far),
                              near.spread(near.straight, near.straight_squares), pass);
  const float left = (1 - plane) * (1 - plane) + plane * plane * tuning::left_by_plane;
  const float of_path = near.spread(near.smooth, near.smooth_squares) * tuning::left_by_plane;
  return {samples_for(of_path * relative, tuning::error_of_matt_path),
          samples_for(variance * left * relative, tuning::error_of_matt_ray)};
}

} // namespace

std::array<MattSamples, TileRays::count> more_samples(const Medium& medium, const TileRays& rays,
                                                      const TileSurfaces& seen, int image_width,
                                                      int pass) {
  std::array<MattSamples, TileRays::count> more;
  const Pixels pixels(rays, seen, image_width);
  for (std::size_t i = 0; i < more.size(); ++i) {
    const TileRays::PixelRay& ray = rays[static_cast<int>(i)];
    if (!ray.inside || seen[i].surface < 0)
      continue;
    const Around near = pixels.around_ray(i);
    if (near.count < fewest_around)
      continue;
    const MattSamples& has = seen[i].samples;
    const float tr = mean_component(transmittance(medium, ray.profile));
    const MattSamples wanted = wanted_samples(near, has.shadow_rays, tr, pass);
    more[i] = {std::max(0, wanted.paths - has.paths),
               std::max(0, wanted.shadow_rays - has.shadow_rays)};
  }
  return more;
}

} // namespace vdbeam
