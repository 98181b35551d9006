#include "math/kernels.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr KernelShape shapes[] = {KernelShape::constant, KernelShape::epanechnikov,
                                  KernelShape::biweight, KernelShape::fourth_order};

/// Integral of f over [0, 1] by the midpoint rule with n points; exact to about 1 / n^2.
template <class F>
double integral(const F& f) {
  constexpr int n = 20000;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    sum += f((i + 0.5) / n);
  return sum / n;
}

TEST(Kernels, IntegrateToOne) {
  for (const KernelShape shape : shapes) {
    EXPECT_NEAR(integral([&](double x) {
                  return 2 * M_PI * x * disc_kernel(shape, static_cast<float>(x * x));
                }),
                1, 1e-6);
    EXPECT_NEAR(integral([&](double x) {
                  return 4 * M_PI * x * x * ball_kernel(shape, static_cast<float>(x * x));
                }),
                1, 1e-6);
  }
}

/// What makes the fourth-order kernel one: its second moment is 0, the others' is not.
TEST(Kernels, FourthOrderHasNoSecondMoment) {
  for (const KernelShape shape : shapes) {
    const double disc = integral([&](double x) {
      return 2 * M_PI * x * x * x * disc_kernel(shape, static_cast<float>(x * x));
    });
    const double ball = integral([&](double x) {
      return 4 * M_PI * std::pow(x, 4) * ball_kernel(shape, static_cast<float>(x * x));
    });
    if (shape == KernelShape::fourth_order) {
      EXPECT_NEAR(disc, 0, 1e-6);
      EXPECT_NEAR(ball, 0, 1e-6);
    } else {
      EXPECT_GT(disc, 0.2);
      EXPECT_GT(ball, 0.2);
    }
  }
}

} // namespace
} // namespace vdbeam
