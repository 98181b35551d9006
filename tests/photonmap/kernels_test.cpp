// The kernels that the queries evaluate are normalised.
#include "photonmap/photon_math-inl.h"

#include <boost/math/quadrature/gauss.hpp>
#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using HWY_NAMESPACE::ball_polynomial;
using HWY_NAMESPACE::disc_polynomial;
using HWY_NAMESPACE::KernelPolynomial;

constexpr KernelShape shapes[] = {KernelShape::constant, KernelShape::epanechnikov,
                                  KernelShape::biweight};

/// Integral over [0, 1] of x^power times the kernel at the distance x, exact for polynomials.
double moment(const KernelPolynomial& kernel, int power) {
  return boost::math::quadrature::gauss<double, 10>::integrate(
      [&](double x) {
        const double k = 1 - x * x;
        const double value =
            static_cast<double>(kernel.step) +
            k * (static_cast<double>(kernel.linear) + k * static_cast<double>(kernel.square));
        return std::pow(x, power) * value;
      },
      0.0, 1.0);
}

TEST(Kernels, IntegrateToOne) {
  for (const KernelShape shape : shapes) {
    EXPECT_NEAR(2 * M_PI * moment(disc_polynomial(shape), 1), 1, 1e-6);
    EXPECT_NEAR(4 * M_PI * moment(ball_polynomial(shape), 2), 1, 1e-6);
  }
}

/// All but the constant one end without a step.
TEST(Kernels, SmoothOnesEndAtZero) {
  for (const KernelShape shape : shapes) {
    EXPECT_EQ(disc_polynomial(shape).step > 0, shape == KernelShape::constant);
    EXPECT_EQ(ball_polynomial(shape).step > 0, shape == KernelShape::constant);
  }
}

} // namespace
} // namespace vdbeam
