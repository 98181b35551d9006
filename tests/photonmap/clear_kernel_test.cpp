#include "photons/clear_kernel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

/// What a ray along a plane, `height` radii before it, sees of photons that lie evenly: their
/// biweight disc kernels, of radius x / sqrt(1 + x^2) at the distance x, integrated along the
/// plane.
double seen(double height) {
  constexpr int steps = 200000;
  constexpr double far = 6;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) * far / steps, radius = x < 3 ? x / std::sqrt(1 + x * x) : 1;
    const double u = (height - x) / radius;
    const double weight = x < 3 ? static_cast<double>(clear_weight(static_cast<float>(x))) : 1;
    if (std::abs(u) < 1)
      sum += weight * 16 / (5 * M_PI) * std::pow(1 - u * u, 2.5) / radius;
  }
  return sum * far / steps;
}

TEST(ClearWeight, even_light_before_a_plane_stays_even) {
  for (const double height : {0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0})
    EXPECT_NEAR(seen(height), 1, 0.04) << height << " radii before the plane";
}

TEST(ClearWeight, no_light_is_lost) {
  constexpr int steps = 100000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += static_cast<double>(clear_weight(static_cast<float>((i + 0.5) * 3 / steps))) * 3 / steps;
  EXPECT_NEAR(sum, 3, 0.01);
}

} // namespace
} // namespace vdbeam
