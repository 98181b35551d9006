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

bool is_uneven(const SeenMedium& seen, const Camera& camera, double world_scale, int x, int y) {
  constexpr int tile = PassImage::tile_width;
  const int x0 = x / tile * tile, y0 = y / tile * tile;
  const int right = std::min(x0 + tile, seen.x0 + seen.width) - 1;
  const int bottom = std::min(y0 + tile, seen.y0 + seen.height) - 1;
  Range opacities, depths;
  for (int py = std::max(y0, y - 1); py <= std::min(bottom, y + 1); ++py)
    for (int px = std::max(x0, x - 1); px <= std::min(right, x + 1); ++px) {
      if (px == x && py == y)
        continue;
      const std::size_t pixel = seen.index(px, py);
      const float opacity = seen.opacity[pixel];
      opacities.add(opacity);
      if (opacity > uneven_opacity)
        depths.add(seen.depth[pixel] / opacity);
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
