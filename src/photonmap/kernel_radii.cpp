#include "photonmap/kernel_radii.h"

#include <tbb/parallel_for.h>

namespace vdbeam {
namespace {

Boxf tight_box(const PhotonBlocks& blocks, std::size_t begin, std::size_t end) {
  Boxf box;
  for (std::size_t i = begin; i < end; ++i)
    box.extend(blocks.position(i));
  return box;
}

/// Radius of the ball that is expected to hold `neighbours` of the `count` photons of a cell, the
/// cell being a box, or as good as a rectangle or a line.
float cell_radius(const Boxf& box, float count, float neighbours) {
  // n uniform points in an interval span (n - 1) / (n + 1) of it; per axis, for points in a box.
  const float widening = (count + 1) / std::max(count - 1, 1.0f);
  Vec3f size = box.size() * widening;
  float e[3] = {size.x, size.y, size.z};
  std::sort(e, e + 3);
  const float share = std::min(1.0f, neighbours / count);
  const float ball = std::cbrt(share * e[0] * e[1] * e[2] * 3 / (4 * pi));
  const float disc = std::sqrt(share * e[1] * e[2] / pi);
  const float line = share * e[2] / 2;
  return std::max({ball, disc, line}) * std::cbrt(std::max(1.0f, neighbours / count));
}

/// Where no least radius was asked for: far below any useful kernel, far above rounding.
float radius_floor(const Boxf& box, float asked) {
  if (asked > 0)
    return asked;
  const Vec3f size = box.size();
  const Vec3f reach = max(max(box.upper, -box.lower), Vec3f(0));
  return std::max({max_component(size) * 1e-5f, max_component(reach) * 1e-6f, 1e-9f});
}

} // namespace

void find_kernel_radii(PhotonBlocks& blocks, const RadiusSettings& settings) {
  const std::size_t count = blocks.count();
  const float floor = radius_floor(tight_box(blocks, 0, count), settings.min_radius);
  const float ceiling = std::max(floor, settings.max_radius);
  const auto clamped = [&](float radius) {
    return std::clamp(radius * settings.scale, floor, ceiling);
  };
  const float neighbours = std::max(1.0f, settings.neighbours);
  std::size_t cell = PhotonBlocks::width;
  while (cell < count && static_cast<float>(cell) < neighbours)
    cell *= 2;
  tbb::parallel_for(std::size_t(0), (count + cell - 1) / cell, [&](std::size_t c) {
    const std::size_t end = std::min(count, (c + 1) * cell);
    // A last, partial cell borrows from the one before, which is not always its sibling but near.
    const std::size_t begin = c * cell;
    const float radius = settings.mode == KernelRadius::fixed
                             ? settings.fixed_radius
                             : cell_radius(tight_box(blocks, begin, end),
                                           static_cast<float>(end - begin), neighbours);
    for (std::size_t i = begin; i < end; ++i)
      blocks.at(i, PhotonBlocks::radius) = clamped(radius);
  });
}

} // namespace vdbeam
