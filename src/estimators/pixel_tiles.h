#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {

inline constexpr int tile_width = 16;

/// Calls visit(x0, y0, x1, y1) for every tile of the image, in parallel; tiles at the right and
/// lower edge may be smaller.
template <class Visit>
void for_each_tile(int width, int height, const Visit& visit) {
  const int columns = (width + tile_width - 1) / tile_width;
  const int rows = (height + tile_width - 1) / tile_width;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, columns * rows, 1), [&](const tbb::blocked_range<int>& range) {
        for (int tile = range.begin(); tile < range.end(); ++tile) {
          const int x = tile % columns * tile_width, y = tile / columns * tile_width;
          visit(x, y, std::min(x + tile_width, width), std::min(y + tile_width, height));
        }
      });
}

} // namespace vdbeam
