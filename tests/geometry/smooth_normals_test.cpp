#include "geometry/smooth_normals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

/// Two triangles that share an edge, the second turned about it by an angle. The vertices of the
/// edge are there twice, as where texture coordinates end.
Mesh fold(double degrees) {
  const auto c = static_cast<float>(std::cos(degrees * M_PI / 180));
  const auto s = static_cast<float>(std::sin(degrees * M_PI / 180));
  Mesh mesh;
  mesh.positions = {{-1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, -1, 0}, {c, 0, -s}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  return mesh;
}

void expect_normal(const Vec3f& normal, double degrees) {
  EXPECT_NEAR(normal.x, std::sin(degrees * M_PI / 180), 1e-6);
  EXPECT_NEAR(normal.y, 0, 1e-6);
  EXPECT_NEAR(normal.z, std::cos(degrees * M_PI / 180), 1e-6);
}

TEST(SmoothNormals, are_means_where_triangles_meet_at_a_small_angle) {
  const auto normals = smooth_normals(fold(40), 50);
  expect_normal(normals[0][0], 0);
  expect_normal(normals[0][1], 20);
  expect_normal(normals[0][2], 20);
  expect_normal(normals[1][0], 20);
  expect_normal(normals[1][1], 40);
  expect_normal(normals[1][2], 20);
}

TEST(SmoothNormals, edges_stay_where_the_angle_is_larger) {
  const auto normals = smooth_normals(fold(60), 50);
  for (int k = 0; k < 3; ++k) {
    expect_normal(normals[0][k], 0);
    expect_normal(normals[1][k], 60);
  }
}

/// Two triangles back to back, as in sheets, each keep their side.
TEST(SmoothNormals, back_to_back) {
  Mesh mesh = fold(0);
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}};
  const auto normals = smooth_normals(mesh, 180);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(normals[0][k].z, 0.99f);
    EXPECT_LT(normals[1][k].z, -0.99f);
  }
}

/// A point at which a hundred thousand triangles meet takes no long time: they stay flat.
TEST(SmoothNormals, a_fan_of_many_triangles) {
  constexpr std::uint32_t count = 100000;
  Mesh mesh;
  mesh.positions.push_back({0, 0, 1});
  for (std::uint32_t i = 0; i <= count; ++i) {
    const double angle = 2 * M_PI * i / count;
    mesh.positions.push_back(
        {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
    if (i > 0)
      mesh.triangles.push_back({0, i, i + 1});
  }
  const auto normals = smooth_normals(mesh, 60);
  for (const CornerNormals& corner : normals)
    EXPECT_NEAR(corner[0].z, std::sqrt(0.5f), 0.01f);
}

} // namespace
} // namespace vdbeam
