#include "image/view_transform.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

double filmic_gray(double x) {
  return view_transform("filmic").apply(Vec3d(x)).y;
}

/// Slope of ln(shown) over ln(x), by a central difference.
double log_slope(double x, double step = 1e-3) {
  return std::log(filmic_gray(x * std::exp(step)) / filmic_gray(x * std::exp(-step))) / (2 * step);
}

TEST(ViewTransform, FilmicKeepsBlackAndMiddleGray) {
  EXPECT_EQ(view_transform("filmic").apply(Vec3d(0)), Vec3d(0));
  EXPECT_NEAR(filmic_gray(0.18), 0.18, 1e-12);
}

/// A straight line to black is no toe: shadows darken, and the curve leaves black with no slope.
TEST(ViewTransform, FilmicHasAToe) {
  for (double x = 1e-6; x < 0.17; x *= 1.3)
    EXPECT_LT(filmic_gray(x), x) << x;
  EXPECT_LT(filmic_gray(0.01), 0.4 * 0.01);
  EXPECT_LT(filmic_gray(1e-6) / 1e-6, 0.02);
  EXPECT_NEAR(log_slope(1e-5), 1.45, 1e-3) << "the documented power";
}

TEST(ViewTransform, FilmicHasMoreContrastThanTheSceneAtMiddleGray) {
  EXPECT_GT(log_slope(0.18), 1.1);
  EXPECT_LT(log_slope(0.18), 1.3);
}

TEST(ViewTransform, FilmicHasASoftShoulder) {
  double before = 0;
  for (double x = 1e-4; x < 1000; x *= 1.2) {
    const double y = filmic_gray(x);
    EXPECT_GT(y, before) << "two brightnesses look the same: " << x;
    EXPECT_LT(y, 1);
    before = y;
  }
  EXPECT_GT(before, 0.99);
  EXPECT_NEAR(filmic_gray(1), 0.7251, 1e-4) << "the documented value";
  EXPECT_LT(filmic_gray(4), 0.96) << "room above white";
}

/// Bounds the curvature on a scale of stops: a corner between two pieces would have any size there,
/// and more of it the finer the step is.
TEST(ViewTransform, TheSlopeOfFilmicIsSmooth) {
  const double stop = 0.01;
  for (double x = 1e-5; x < 100; x *= std::exp2(stop))
    EXPECT_LT(std::abs(log_slope(x * std::exp2(stop), 1e-4) - log_slope(x, 1e-4)), 0.5 * stop) << x;
}

TEST(ViewTransform, FilmicFallsInContrastTowardsWhite) {
  double before = log_slope(1e-5);
  for (double x = 1e-4; x < 50; x *= 1.5) {
    const double slope = log_slope(x);
    EXPECT_LT(slope, before + 1e-9) << x;
    before = slope;
  }
}

TEST(ViewTransform, FilmicFadesBrightColoursInTheirOwnOrder) {
  const auto view = view_transform("filmic").apply;
  double saturation = 1;
  for (double scale = 0.25; scale < 500; scale *= 2) { // the orange of a flame
    const Vec3d shown = view(Vec3d(1, 0.4, 0.1) * scale);
    EXPECT_GT(shown.x, shown.y);
    EXPECT_GT(shown.y, shown.z);
    EXPECT_LE(1 - shown.z / shown.x, saturation + 1e-9);
    saturation = 1 - shown.z / shown.x;
  }
  EXPECT_LT(saturation, 0.5);
  const Vec3d blue = view({0, 0, 1e30});
  EXPECT_EQ(blue.x, 0);
  EXPECT_LE(blue.z, 1 + 1e-12);
}

TEST(ViewTransform, SrgbClips) {
  const auto view = view_transform("srgb").apply;
  EXPECT_EQ(view({0.25, 1.5, 0}), Vec3d(0.25, 1, 0));
}

TEST(ViewTransform, UnknownNamesAreInputErrors) {
  EXPECT_THROW(view_transform("flimic"), InputError);
}

} // namespace
} // namespace vdbeam
