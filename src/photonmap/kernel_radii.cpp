#include "photonmap/kernel_radii.h"

#include "photonmap/cell_radii.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace vdbeam {
namespace {

/// Where no least radius was asked for: far below any useful kernel, far above rounding. A few
/// photons that lie very far away, on a plane without an end, do not raise it.
float radius_floor(const PhotonBlocks& blocks, const RadiusSettings& settings) {
  if (settings.min_radius > 0)
    return settings.min_radius;
  constexpr float share_of_widest = 1e-4f;
  constexpr std::size_t photons_at_once = 4096;
  const Boxf box = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, blocks.count(), photons_at_once), Boxf(),
      [&](const tbb::blocked_range<std::size_t>& range, Boxf so_far) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          so_far.extend(blocks.position(i));
        return so_far;
      },
      [](Boxf a, const Boxf& b) {
        a.extend(b);
        return a;
      });
  const Vec3f reach = max(max(box.upper, -box.lower), Vec3f(0));
  const float of_all = std::max(max_component(box.size()) * 1e-5f, max_component(reach) * 1e-6f);
  return std::max(std::min(of_all, share_of_widest * settings.max_radius), 1e-9f);
}

} // namespace

void find_kernel_radii(PhotonBlocks& blocks, const RadiusSettings& settings) {
  const std::size_t count = blocks.count();
  if (count == 0)
    return;
  const float floor = radius_floor(blocks, settings);
  const float ceiling = std::max(floor, settings.max_radius);
  const float neighbours = std::max(1.0f, settings.neighbours);
  std::size_t cell = 1;
  std::vector<float> radii(1, settings.fixed_radius);
  if (settings.mode == KernelRadius::adaptive) {
    while (static_cast<float>(2 * cell * PhotonBlocks::width) <=
               neighbours * tuning::cell_of_neighbours &&
           2 * cell * PhotonBlocks::width <= count)
      cell *= 2;
    radii = find_cell_radii(blocks, cell, neighbours);
  } else {
    cell = blocks.block_count();
  }
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    const float radius = radii[i / (cell * PhotonBlocks::width)] * settings.scale;
    blocks.at(i, PhotonBlocks::radius) = std::clamp(radius, floor, ceiling);
  });
}

} // namespace vdbeam
