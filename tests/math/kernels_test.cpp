#include "math/kernels.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

constexpr KernelShape shapes[] = {KernelShape::constant, KernelShape::epanechnikov,
                                  KernelShape::biweight, KernelShape::fourth_order};

// Integral of f over s in [0, 1) by the midpoint rule.
template <class F>
double integrate(F f) {
  constexpr int steps = 100000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += f((i + 0.5) / steps) / steps;
  return sum;
}

TEST(Kernels, DiscKernelsIntegrateToOne) {
  for (const KernelShape shape : shapes)
    EXPECT_NEAR(integrate([&](double s) {
                  return static_cast<double>(disc_kernel(shape, static_cast<float>(s))) *
                         std::numbers::pi;
                }),
                1, 1e-6);
}

TEST(Kernels, BallKernelsIntegrateToOne) {
  for (const KernelShape shape : shapes)
    EXPECT_NEAR(integrate([&](double r) {
                  return static_cast<double>(ball_kernel(shape, static_cast<float>(r * r))) * 4 *
                         std::numbers::pi * r * r;
                }),
                1, 1e-6);
}

// The fourth-order kernels have no second moment, so their bias falls with the fourth power.
TEST(Kernels, FourthOrderHasNoSecondMoment) {
  const double disc = integrate([](double s) {
    return static_cast<double>(disc_kernel(KernelShape::fourth_order, static_cast<float>(s))) * s;
  });
  const double ball = integrate([](double r) {
    const float s = static_cast<float>(r * r);
    return static_cast<double>(ball_kernel(KernelShape::fourth_order, s)) * r * r * r * r;
  });
  EXPECT_NEAR(disc, 0, 1e-7);
  EXPECT_NEAR(ball, 0, 1e-6);
}

TEST(Kernels, SmoothOnesEndAtZero) {
  for (const KernelShape shape :
       {KernelShape::epanechnikov, KernelShape::biweight, KernelShape::fourth_order}) {
    EXPECT_EQ(disc_kernel(shape, 1), 0);
    EXPECT_EQ(ball_kernel(shape, 1), 0);
    EXPECT_GT(disc_kernel(shape, 0), 0);
    EXPECT_GT(ball_kernel(shape, 0), 0);
  }
}

} // namespace
} // namespace vdbeam
