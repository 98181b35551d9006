#include "rays/uneven_pixels.h"

#include "tuning/constants.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbeam {

namespace {

struct Range {
  float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();

  void add(float value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  float width() const { return std::max(0.0f, most - least); }
};

/// Calls visit(index, dx, dy) for the pixels of the tile that surround pixel (x, y).
template <class Visit>
void for_each_around(const SeenMedium& seen, int x, int y, const Visit& visit) {
  constexpr int tile = PassImage::tile_width;
  const int x0 = x / tile * tile, y0 = y / tile * tile;
  const int right = std::min(x0 + tile, seen.x0 + seen.width) - 1;
  const int bottom = std::min(y0 + tile, seen.y0 + seen.height) - 1;
  for (int py = std::max(y0, y - 1); py <= std::min(bottom, y + 1); ++py)
    for (int px = std::max(x0, x - 1); px <= std::min(right, x + 1); ++px)
      if (px != x || py != y)
        visit(seen.index(px, py), px - x, py - y);
}

} // namespace

bool is_uneven(const SeenMedium& seen, const Camera& camera, double world_scale, int x, int y) {
  Range opacities, depths;
  for_each_around(seen, x, y, [&](std::size_t pixel, int, int) {
    const float opacity = seen.opacity[pixel];
    opacities.add(opacity);
    if (opacity > tuning::uneven_opacity)
      depths.add(seen.depth[pixel] / opacity);
  });
  if (opacities.width() > tuning::uneven_opacity)
    return true;
  if (!(depths.width() > 0))
    return false;
  const double pixel =
      camera.pixel_width(x + 0.5, y + 0.5, static_cast<double>(depths.least) * world_scale) /
      world_scale;
  return depths.width() > tuning::uneven_widths * static_cast<float>(pixel);
}

bool is_unevenly_lit(const SeenMedium& seen, const EndOfRay* ends, int x, int y) {
  // A plane through the values around: an edge is much of a slope and little besides, noise is not.
  float count = 0, value = 0, across = 0, down = 0, most = 0;
  bool surface = false;
  for_each_around(seen, x, y, [&](std::size_t pixel, int dx, int dy) {
    ++count;
    value += ends[pixel].light;
    across += static_cast<float>(dx);
    down += static_cast<float>(dy);
    most = std::max(most, ends[pixel].light);
    surface |= ends[pixel].surface;
  });
  if (!surface)
    return false;
  const Vec3f mean = Vec3f(across, down, value) / count;
  const auto from_mean = [&](std::size_t pixel, int dx, int dy) {
    return Vec3f(static_cast<float>(dx), static_cast<float>(dy), ends[pixel].light) - mean;
  };
  Vec3f squares, products;
  for_each_around(seen, x, y, [&](std::size_t pixel, int dx, int dy) {
    const Vec3f d = from_mean(pixel, dx, dy);
    squares += d * d;
    products += d * d.z;
  });
  if (!(squares.x > 0 && squares.y > 0))
    return false;
  const float slope_x = products.x / squares.x, slope_y = products.y / squares.y;
  const float step = 2 * std::hypot(slope_x, slope_y);
  if (!(step > tuning::least_step_of_light * most))
    return false;
  float residual = 0;
  for_each_around(seen, x, y, [&](std::size_t pixel, int dx, int dy) {
    const Vec3f d = from_mean(pixel, dx, dy);
    const float rest = d.z - slope_x * d.x - slope_y * d.y;
    residual += rest * rest / count;
  });
  return std::sqrt(residual) < tuning::most_noise_of_step * step;
}

} // namespace vdbeam
