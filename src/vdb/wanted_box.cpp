#include "vdb/wanted_box.h"

#include "vdb/raw_grid.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Reach of cubic interpolation (2), displacement by noise and motion (1 each) beyond a point,
/// in voxels of the grid, rounded up.
constexpr double reach = 5;
constexpr double farthest = 1 << 30; // OpenVDB's coordinates have 32 bits

} // namespace

WantedBox::Voxels WantedBox::voxels(const Affine& index_to_world) const {
  const Boxd index = index_to_world.inverse().bounds(world);
  Voxels voxels;
  for (int a = 0; a < 3; ++a) {
    const auto leaf = [](double x) {
      return leaf_width *
             static_cast<std::int64_t>(std::floor(std::clamp(x, -farthest, farthest) / leaf_width));
    };
    voxels.lower[a] = leaf(index.lower[a] - reach);
    voxels.upper[a] = leaf(index.upper[a] + reach) + leaf_width - 1;
  }
  return voxels;
}

} // namespace vdbeam
