#include "rays/tile_rays.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Where the rays of a pixel lie, relative to its own. No two lie in one row or column, so that
/// they show more of edges along the axes, such as a horizon.
constexpr std::array<double, 2> lattice[TileRays::rays_if_refined] = {
    {0, 0}, {0.5, 0.25}, {0.75, 0.5}, {0.25, 0.75}};

} // namespace

TileRays::PixelRay TileRays::pixel_ray(const EstimatorInput& input, const RngKey& key, int x, int y,
                                       int number) {
  PixelRay ray;
  ray.inside = true;
  const std::size_t pixels = static_cast<std::size_t>(input.camera.width()) * input.camera.height();
  ray.pixel = static_cast<std::size_t>(y) * input.camera.width() + x;
  ray.stream = ray.pixel + static_cast<std::size_t>(number) * pixels;
  Rng rng(key, RngStage::camera, ray.pixel); // the same numbers for all of its rays
  ray.eye = input.camera.sample(x, y, rng, lattice[number]);
  ray.camera = camera_ray(input.world, input.camera, ray.eye);
  return ray;
}

void TileRays::prepare(const EstimatorInput& input, const RngKey& key, int x0, int y0) {
  const Camera& camera = input.camera;
  x0_ = x0;
  y0_ = y0;
  used_ = 0;
  first_more_.fill(-1);
  for (int i = 0; i < count; ++i) {
    const int x = x0 + column(i), y = y0 + row(i);
    PixelRay& out = rays_[i];
    DepthProfile profile = std::move(out.profile); // for its memory
    out = pixel_ray(input, key, std::min(x, camera.width() - 1), std::min(y, camera.height() - 1));
    out.profile = std::move(profile);
    out.inside = x < camera.width() && y < camera.height();
    Segment segment = out.camera.segment;
    if (!out.inside || input.stopped())
      segment.t_end = segment.t_begin;
    out.profile.build(input.world.medium, segment, static_cast<float>(input.settings.cutoff),
                      out.camera.air);
  }
}

void TileRays::refine(const EstimatorInput& input, const RngKey& key, int ray) {
  const auto width = static_cast<std::size_t>(input.camera.width());
  const int x = static_cast<int>(rays_[ray].pixel % width);
  const int y = static_cast<int>(rays_[ray].pixel / width);
  first_more_[ray] = static_cast<int>(used_);
  for (int number = 1; number < rays_if_refined; ++number) {
    if (used_ == more_.size())
      more_.emplace_back();
    PixelRay& out = more_[used_++];
    DepthProfile profile = std::move(out.profile);
    out = pixel_ray(input, key, x, y, number);
    out.profile = std::move(profile);
    out.profile.build(input.world.medium, out.camera.segment,
                      static_cast<float>(input.settings.cutoff), out.camera.air);
  }
}

bool TileRays::show_surface() const {
  return std::any_of(rays_.begin(), rays_.end(),
                     [](const PixelRay& ray) { return ray.inside && ray.camera.hit; });
}

std::span<const TileRays::PixelRay> TileRays::more(int ray) const {
  const int first = first_more_[ray];
  if (first < 0)
    return {};
  return {more_.data() + first, static_cast<std::size_t>(rays_if_refined - 1)};
}

} // namespace vdbeam
