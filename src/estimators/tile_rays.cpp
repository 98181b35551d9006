#include "estimators/tile_rays.h"

namespace vdbeam {

void TileRays::prepare(const EstimatorInput& input, const RngKey& key, int x0, int y0) {
  const World& world = input.world;
  const Camera& camera = input.camera;
  x0_ = x0;
  y0_ = y0;
  for (int i = 0; i < count; ++i) {
    const int subtile = i / 16, ray = i % 16;
    const int x = x0 + subtile % 4 * 4 + ray % 4, y = y0 + subtile / 4 * 4 + ray / 4;
    PixelRay& out = rays_[i];
    out.inside = x < camera.width() && y < camera.height();
    const int px = std::min(x, camera.width() - 1), py = std::min(y, camera.height() - 1);
    out.pixel = static_cast<std::size_t>(py) * camera.width() + px;
    Rng rng(key, RngStage::camera, out.pixel);
    out.eye = camera.sample(px, py, rng);
    out.camera = camera_ray(world, camera, out.eye);
    Segment segment = out.camera.segment;
    if (!out.inside)
      segment.t_end = segment.t_begin;
    out.profile.build(world.medium, segment, static_cast<float>(input.settings.cutoff));
  }
}

} // namespace vdbeam
