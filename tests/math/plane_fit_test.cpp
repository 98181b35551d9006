#include "math/plane_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

/// A plane is found again, whatever the weights and wherever the places lie.
TEST(PlaneFit, GivesBackAPlane) {
  for (const double shift : {0.0, 0.5, 3.0}) {
    PlaneFit fit;
    double sum = 0;
    const auto weight = [](int i, int j) { return 1 + 0.3 * std::sin(3.0 * i + j); };
    const auto value = [](double x, double y) { return 2 + 0.7 * x - 0.4 * y; };
    for (int i = -2; i <= 2; ++i)
      for (int j = -1; j <= 2; ++j)
        fit.add(weight(i, j), i + shift, j);
    const auto row = fit.row();
    double ones = 0;
    for (int i = -2; i <= 2; ++i)
      for (int j = -1; j <= 2; ++j) {
        const double share = weight(i, j) * (row[0] + row[1] * (i + shift) + row[2] * j);
        sum += share * value(i + shift, j);
        ones += share;
      }
    EXPECT_NEAR(ones, 1, 0.01) << shift;
    EXPECT_NEAR(sum, 2, 0.02) << shift; // the ridge holds the slope back a little
  }
}

/// Places in a row leave the slope across it at 0.
TEST(PlaneFit, OfARowHasNoSlopeAcross) {
  PlaneFit fit;
  for (int i = -2; i <= 2; ++i)
    fit.add(1, i, 0);
  const auto row = fit.row();
  EXPECT_NEAR(5 * row[0], 1, 1e-9);
  EXPECT_NEAR(row[2], 0, 1e-9);
}

} // namespace
} // namespace vdbeam
