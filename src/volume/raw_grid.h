#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdbeam {

/// A grid as it lies in the file, free of OpenVDB's types: 8^3 leaves, and tiles of one value.

inline constexpr int leaf_width = 8;
inline constexpr int leaf_size = leaf_width * leaf_width * leaf_width;

/// A cube of one value: `width` voxels (a power of two, at least 8) from `origin` on.
struct RawTile {
  std::array<std::int32_t, 3> origin;
  std::int32_t width;
  float value;
};

/// Leaves in ascending order of their origins (x, then y, then z), none twice; values x-major.
struct RawGrid {
  std::size_t leaf_count = 0;
  const std::int32_t* leaf_origins = nullptr; ///< 3 per leaf, multiples of 8
  float* leaf_values = nullptr;               ///< leaf_size per leaf; mended in place
  std::vector<RawTile> tiles;
  bool level_set = false; ///< values are signed distances, negative inside
  /// Called with how many leaves from the first on are not needed any more (ever more of them).
  std::function<void(std::size_t)> release = [](std::size_t) {};
};

} // namespace vdbeam
