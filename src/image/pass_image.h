#pragma once

#include "vdbeam/vec.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// What one pass of an estimator gives: one value per pixel and output, row-major from the top
/// left.
struct PassImage {
  int width = 0, height = 0;
  std::vector<Rgb> direct;     ///< single scattering of lights estimated by shadow rays
  std::vector<Rgb> indirect;   ///< everything else scattered in the volume
  std::vector<Rgb> background; ///< lights seen through the volume: Tr * escaped radiance
  std::vector<Rgb> emission;   ///< the medium's own light, Tr * j; empty where nothing glows
  std::vector<float> opacity;  ///< 1 - Tr of the whole ray (mean over channels)
  /// Opacity times the mean distance [world] of the first collision: integral of Tr sigma_t t dt.
  /// Sum over passes, divided by the sum of opacity, it is the mean depth (AOV volume_Z).
  std::vector<float> depth;
  /// Per tile of the picture, row by row: whether its pixels that were asked for are finished,
  /// which all of them are unless the pass was stopped.
  std::vector<std::uint8_t> finished_tiles;
  static constexpr int tile_width = 16;

  /// `glows`: there is something to hold in `emission`.
  void resize(int w, int h, bool glows = false) {
    width = w;
    height = h;
    const std::size_t n = static_cast<std::size_t>(w) * h;
    direct.assign(n, {});
    indirect.assign(n, {});
    background.assign(n, {});
    emission.assign(glows ? n : 0, {});
    opacity.assign(n, 0);
    depth.assign(n, 0);
    finished_tiles.assign(static_cast<std::size_t>(tile_columns()) *
                              static_cast<std::size_t>((h + tile_width - 1) / tile_width),
                          0);
  }
  int tile_columns() const { return (width + tile_width - 1) / tile_width; }
  std::size_t tile_of(int x, int y) const {
    return static_cast<std::size_t>(y / tile_width) * static_cast<std::size_t>(tile_columns()) +
           static_cast<std::size_t>(x / tile_width);
  }
  /// What the pixel shows in all.
  Rgb total(std::size_t pixel) const {
    const Rgb sum = direct[pixel] + indirect[pixel] + background[pixel];
    return emission.empty() ? sum : sum + emission[pixel];
  }
};

} // namespace vdbeam
