#include "estimators/tile_rays.h"

namespace vdbeam {

TileRays::PixelRay TileRays::pixel_ray(const EstimatorInput& input, const RngKey& key, int x,
                                       int y) {
  PixelRay ray;
  ray.inside = true;
  ray.pixel = static_cast<std::size_t>(y) * input.camera.width() + x;
  Rng rng(key, RngStage::camera, ray.pixel);
  ray.eye = input.camera.sample(x, y, rng);
  ray.camera = camera_ray(input.world, input.camera, ray.eye);
  return ray;
}

void TileRays::prepare(const EstimatorInput& input, const RngKey& key, int x0, int y0) {
  const Camera& camera = input.camera;
  x0_ = x0;
  y0_ = y0;
  for (int i = 0; i < count; ++i) {
    const int subtile = i / 16, ray = i % 16;
    const int x = x0 + subtile % 4 * 4 + ray % 4, y = y0 + subtile / 4 * 4 + ray / 4;
    PixelRay& out = rays_[i];
    DepthProfile profile = std::move(out.profile); // for its memory
    out = pixel_ray(input, key, std::min(x, camera.width() - 1), std::min(y, camera.height() - 1));
    out.profile = std::move(profile);
    out.inside = x < camera.width() && y < camera.height();
    Segment segment = out.camera.segment;
    if (!out.inside)
      segment.t_end = segment.t_begin;
    out.profile.build(input.world.medium, segment, static_cast<float>(input.settings.cutoff));
  }
}

} // namespace vdbeam
