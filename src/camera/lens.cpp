#include "camera/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

/// Uniform on the unit disc, keeping strata together (Shirley and Chiu 1997).
Vec3d concentric_disc(double u, double v) {
  const double x = 2 * u - 1, y = 2 * v - 1;
  if (x == 0 && y == 0)
    return {};
  constexpr double quarter = std::numbers::pi / 4;
  const bool wide = std::abs(x) > std::abs(y);
  const double r = wide ? x : y;
  const double phi = wide ? quarter * (y / x) : 2 * quarter - quarter * (x / y);
  return {r * std::cos(phi), r * std::sin(phi), 0};
}

} // namespace

Vec3d Lens::sample(double u, double v) const {
  if (blades_ < 3)
    return concentric_disc(u, v) * radius_;
  // One of the triangles between the centre and an edge, then a point of it.
  const double place = u * blades_;
  const double blade = std::min(std::floor(place), blades_ - 1.0);
  const double root = std::sqrt(place - blade);
  const double step = 2 * std::numbers::pi / blades_;
  const double first = angle_ * std::numbers::pi / 180 + blade * step, second = first + step;
  const double a = root * (1 - v) * radius_, b = root * v * radius_;
  return {a * std::cos(first) + b * std::cos(second), a * std::sin(first) + b * std::sin(second),
          0};
}

} // namespace vdbeam
