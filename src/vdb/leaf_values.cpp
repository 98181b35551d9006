#include "vdb/leaf_values.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace vdbeam {

namespace {

/// The bits of a leaf's values. Those of densities are in the order of the densities, and integers
/// can be compared many at a time without regard to NaN.
using LeafBits = std::array<std::uint32_t, leaf_size>;

LeafBits bits_of(const float* values) {
  LeafBits bits;
  std::memcpy(bits.data(), values, sizeof bits);
  return bits;
}

template <int nx, int ny, int nz>
ValueRange range_of(const LeafBits& bits) {
  std::uint32_t lowest = bits[0], highest = bits[0];
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z) {
        const std::uint32_t value = bits[(x * leaf_width + y) * leaf_width + z];
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
      }
  return {std::bit_cast<float>(lowest), std::bit_cast<float>(highest)};
}

/// Where the fog reaches density 1 inside a level set: the tiles' distance, which is the narrow
/// band's, or that of the deepest voxel where there are no tiles.
float fog_depth(const RawGrid& grid) {
  float depth = 0;
  for (const RawTile& tile : grid.tiles)
    if (std::isfinite(tile.value))
      depth = std::max(depth, -tile.value);
  if (depth > 0)
    return depth;
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, grid.leaf_count, 64), std::numeric_limits<float>::min(),
      [&grid](const tbb::blocked_range<std::size_t>& leaves, float deepest) {
        const float* end = grid.leaf_values + leaves.end() * leaf_size;
        for (const float* v = grid.leaf_values + leaves.begin() * leaf_size; v != end; ++v)
          if (std::isfinite(*v))
            deepest = std::max(deepest, -*v);
        return deepest;
      },
      [](float a, float b) { return std::max(a, b); });
}

} // namespace

LeafRanges measure_leaf(const float* values) {
  const LeafBits bits = bits_of(values);
  return {range_of<8, 8, 8>(bits), range_of<8, 8, 1>(bits), range_of<8, 1, 8>(bits),
          range_of<8, 1, 1>(bits), range_of<1, 8, 8>(bits), range_of<1, 8, 1>(bits),
          range_of<1, 1, 8>(bits), range_of<1, 1, 1>(bits)};
}

Mender::Mender(const RawGrid& grid)
    : level_set_(grid.level_set), per_distance_(level_set_ ? 1 / fog_depth(grid) : 0) {}

float Mender::mend(float value, GridRepairs& repairs, std::uint64_t weight) const {
  if (std::isnan(value)) {
    repairs.nan += weight;
    return 0;
  }
  if (std::isinf(value)) {
    repairs.infinite += weight;
    return 0;
  }
  if (level_set_)
    return value < 0 ? std::min(-value * per_distance_, 1.0f) : 0;
  if (value < 0) {
    repairs.negative += weight;
    return 0;
  }
  return value == 0 ? 0 : value; // -0 becomes 0
}

void Mender::mend_leaf(float* values, GridRepairs& repairs) const {
  if (!level_set_) {
    // Nothing to mend where no sign bit is set and no exponent is that of NaN and infinity.
    const LeafBits bits = bits_of(values);
    std::uint32_t largest = 0;
    for (const std::uint32_t value : bits)
      largest = std::max(largest, value);
    if (largest < 0x7f800000)
      return;
  }
  for (int i = 0; i < leaf_size; ++i)
    values[i] = mend(values[i], repairs);
}

} // namespace vdbeam
