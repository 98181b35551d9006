#pragma once

#include "rays/estimator_input.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {

inline constexpr int tile_width = PassImage::tile_width;

/// The pixels that are wanted.
inline PixelRegion wanted(const EstimatorInput& input) {
  return input.window.empty() ? PixelRegion{0, 0, input.camera.width(), input.camera.height()}
                              : input.window;
}

/// A window and `reach` pixels around it.
inline PixelRegion widened(const PixelRegion& window, int reach, const Camera& camera) {
  return {std::max(0, window.x0 - reach), std::max(0, window.y0 - reach),
          std::min(camera.width(), window.x1 + reach),
          std::min(camera.height(), window.y1 + reach)};
}

/// Calls visit(x0, y0, x1, y1) for every tile of the image that meets the input's window, in
/// parallel; tiles at the right and lower edge may be smaller. Tiles lie on the same grid whatever
/// the window, since what a tile's pixels get may depend on its other pixels. Stops between tiles
/// when the input asks for it, and marks in `image` which ones are finished.
template <class Visit>
void for_each_tile(const EstimatorInput& input, PassImage& image, const Visit& visit) {
  const int width = input.camera.width(), height = input.camera.height();
  const PixelRegion window = wanted(input);
  const int first_column = window.x0 / tile_width, first_row = window.y0 / tile_width;
  const int columns = (window.x1 + tile_width - 1) / tile_width - first_column;
  const int rows = (window.y1 + tile_width - 1) / tile_width - first_row;
  tbb::parallel_for(
      tbb::blocked_range<int>(0, columns * rows, 1), [&](const tbb::blocked_range<int>& range) {
        for (int tile = range.begin(); tile < range.end() && !input.stopped(); ++tile) {
          const int x = (first_column + tile % columns) * tile_width;
          const int y = (first_row + tile / columns) * tile_width;
          visit(x, y, std::min(x + tile_width, width), std::min(y + tile_width, height));
          image.finished_tiles[image.tile_of(x, y)] = !input.stopped();
        }
      });
}

} // namespace vdbeam
