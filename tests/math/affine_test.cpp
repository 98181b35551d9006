#include "math/affine.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

Affine sheared() {
  Affine m;
  m.rows = {Vec3d{2, 0.5, -1}, Vec3d{0.1, -3, 0.2}, Vec3d{1, 1, 0.7}};
  m.translation = {1e6, -2e6, 5};
  return m;
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a[i], b[i], tolerance);
}

TEST(Affine, PointAndVectorDifferByTheTranslation) {
  const Affine m = sheared();
  expect_near(m.vector({1, 2, 3}), {2 + 1 - 3, 0.1 - 6 + 0.6, 1 + 2 + 2.1}, 1e-14);
  expect_near(m.point({1, 2, 3}) - m.vector({1, 2, 3}), m.translation, 1e-9);
  EXPECT_NEAR(m.determinant(), 2 * (-3 * 0.7 - 0.2) - 0.5 * (0.07 - 0.2) - (0.1 + 3), 1e-14);
}

TEST(Affine, InverseUndoesTheMap) {
  const Affine m = sheared(), inverse = m.inverse();
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, -2, 3}, Vec3d{100, 20, -7}}) {
    expect_near(inverse.point(m.point(p)), p, 1e-9);
    expect_near(m.vector(inverse.vector(p)), p, 1e-12);
  }
  EXPECT_NEAR(inverse.determinant() * m.determinant(), 1, 1e-14);
}

TEST(Affine, AfterAppliesTheOtherFirst) {
  Affine scale;
  scale.rows = {Vec3d{2, 0, 0}, Vec3d{0, 3, 0}, Vec3d{0, 0, 4}};
  scale.translation = {1, 1, 1};
  const Affine m = sheared(), both = m.after(scale);
  for (const Vec3d& p : {Vec3d{0, 0, 0}, Vec3d{1, -2, 3}}) {
    expect_near(both.point(p), m.point(scale.point(p)), 1e-9);
    expect_near(both.vector(p), m.vector(scale.vector(p)), 1e-12);
  }
}

TEST(Box, GrowsFromEmpty) {
  Boxd box;
  EXPECT_TRUE(box.empty());
  box.extend(Vec3d{1, 2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.size(), Vec3d());
  Boxd other;
  other.extend(Vec3d{-1, 4, 0});
  box.extend(other);
  EXPECT_EQ(box.lower, Vec3d(-1, 2, 0));
  EXPECT_EQ(box.upper, Vec3d(1, 4, 3));
  EXPECT_EQ(box.center(), Vec3d(0, 3, 1.5));
  box.extend(Boxd{});
  EXPECT_EQ(box.size(), Vec3d(2, 2, 3));
}

} // namespace
} // namespace vdbeam
