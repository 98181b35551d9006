#include "rays/uneven_pixels.h"

#include <algorithm>
#include <limits>

namespace vdbeam {

namespace {

/// Differences among the pixels around: of opacity, and of the depth of those that are at least so
/// opaque, in widths of a pixel there.
constexpr float uneven_opacity = 0.3f;
constexpr float uneven_widths = 8;

struct Range {
  float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();

  void add(float value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  float width() const { return std::max(0.0f, most - least); }
};

} // namespace

bool is_uneven(const PassImage& image, const Camera& camera, double world_scale, int x, int y) {
  constexpr int tile = PassImage::tile_width;
  const int x0 = x / tile * tile, y0 = y / tile * tile;
  Range opacities, depths;
  for (int py = std::max(y0, y - 1); py <= std::min({y0 + tile - 1, image.height - 1, y + 1}); ++py)
    for (int px = std::max(x0, x - 1); px <= std::min({x0 + tile - 1, image.width - 1, x + 1});
         ++px) {
      if (px == x && py == y)
        continue;
      const auto pixel = static_cast<std::size_t>(py) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(px);
      const float opacity = image.opacity[pixel];
      opacities.add(opacity);
      if (opacity > uneven_opacity)
        depths.add(image.depth[pixel] / opacity);
    }
  if (opacities.width() > uneven_opacity)
    return true;
  if (!(depths.width() > 0))
    return false;
  const double pixel =
      camera.pixel_width(x + 0.5, y + 0.5, static_cast<double>(depths.least) * world_scale) /
      world_scale;
  return depths.width() > uneven_widths * static_cast<float>(pixel);
}

} // namespace vdbeam
