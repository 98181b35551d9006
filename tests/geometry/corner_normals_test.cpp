#include "geometry/corner_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

/// Two triangles in the plane z = 0 with their front towards +z, which share an edge.
Mesh square() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh square_with(const std::vector<Vec3f>& normals) {
  Mesh mesh = square();
  take_normals(normals, "label", mesh);
  return mesh;
}

TEST(CornerNormals, are_of_unit_length) {
  const Mesh mesh = square_with({{0, 0, 2}, {3, 0, 4}, {0, 1e-20f, 1e-20f}, {0, 0, 1e30f}});
  EXPECT_TRUE(mesh.notes.empty());
  ASSERT_EQ(mesh.normals.size(), 2u);
  EXPECT_NEAR(mesh.normals[0][1].x, 0.6f, 1e-6f);
  EXPECT_NEAR(mesh.normals[0][1].z, 0.8f, 1e-6f);
  for (const CornerNormals& corners : mesh.normals)
    for (const Vec3f& normal : corners)
      EXPECT_NEAR(length(normal), 1, 1e-6f);
}

/// NaN, infinities and no length: the corner has none, and a note says so in one line.
TEST(CornerNormals, that_cannot_be_used) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Mesh mesh = square_with({{NAN, 0, 1}, {0, 0, 0}, {0.6f, 0, 0.8f}, {0, infinity, 0}});
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "label: 4 of 6 triangle corners have no valid normal and are shaded "
                           "without one");
  EXPECT_EQ(mesh.normals[0][0], Vec3f());
  complete_normals(mesh, 0);
  EXPECT_EQ(mesh.normals[0][0], Vec3f(0, 0, 1));
  EXPECT_NEAR(mesh.normals[0][2].x, 0.6f, 1e-6f);
}

/// The order of the vertices says what the front is: dielectrics depend on it.
TEST(CornerNormals, of_the_back_are_turned_round) {
  const Mesh mesh = square_with({{0, 0, -1}, {0, 0.6f, -0.8f}, {0, 0, -1}, {0, 0, 1}});
  ASSERT_EQ(mesh.notes.size(), 1u);
  EXPECT_EQ(mesh.notes[0], "label: the normals of 1 of 2 triangles point to the back (by the "
                           "vertex order) and are reversed");
  EXPECT_NEAR(mesh.normals[0][1].y, -0.6f, 1e-6f);
  EXPECT_NEAR(mesh.normals[0][1].z, 0.8f, 1e-6f);
  // Where others of the triangle point to the front, one that does not is left out.
  EXPECT_EQ(mesh.normals[1][0], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[1][1], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.normals[1][2], Vec3f(0, 0, 1));
}

/// Exporters write the normals of flat triangles too: they take no memory.
TEST(CornerNormals, of_flat_triangles_are_left_out) {
  Mesh mesh = square_with({{0, 0, 1}, {0, 0.0001f, 1}, {0, 0, 1}, {0, 0, 1}});
  complete_normals(mesh, 0);
  EXPECT_TRUE(mesh.normals.empty());
  mesh = square_with({{0, 0, 1}, {0, 0.001f, 1}, {0, 0, 1}, {0, 0, 1}});
  complete_normals(mesh, 0);
  EXPECT_EQ(mesh.normals.size(), 2u);
}

/// Parts without normals of a file whose other parts have them are smoothed by the angle.
TEST(CornerNormals, that_are_missing_come_from_the_angle) {
  Mesh mesh = square();
  mesh.positions[3].z = 0.5f; // folds the second triangle up
  Mesh smoothed = mesh;
  complete_normals(smoothed, 90);
  take_normals({{0.6f, 0, 0.8f}, {}, {}, {}}, "label", mesh);
  complete_normals(mesh, 90);
  EXPECT_NEAR(mesh.normals[0][0].x, 0.6f, 1e-6f);
  EXPECT_EQ(mesh.normals[0][1], smoothed.normals[0][1]);
  EXPECT_EQ(mesh.normals[1][1], smoothed.normals[1][1]);
  EXPECT_NE(smoothed.normals[1][1], Vec3f(0, 0, 1));
}

} // namespace
} // namespace vdbeam
