#include "math/opacity.h"
#include "medium/depth_profile.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(Opacity, IsOneMinusTheTransmittanceToSevenDigits) {
  for (double x = -12; x < 2; x += 0.001) {
    const float tau = static_cast<float>(std::pow(10.0, x));
    const double exact = -std::expm1(-static_cast<double>(tau));
    ASSERT_NEAR(opacity_of(tau), exact, 5e-7 * exact) << tau;
  }
  EXPECT_EQ(opacity_of(0), 0);
  EXPECT_EQ(opacity_of(std::numeric_limits<float>::infinity()), 1);
}

TEST(Opacity, MeanCollisionIsThatOfACutExponential) {
  for (double x = -6; x < 2; x += 0.001) {
    const float tau = static_cast<float>(std::pow(10.0, x));
    const double t = static_cast<double>(tau);
    const double exact = t < 1e-4 ? 0.5 - t / 12 : 1 / t - 1 / std::expm1(t);
    ASSERT_NEAR(mean_collision(tau), exact, 1e-5 * exact + 3e-7) << tau;
  }
}

} // namespace
} // namespace vdbeam
