#include "geometry/mesh_reader.h"

#include "geometry/gltf/gltf_files.h"
#include "support/gltf.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace vdbeam {
namespace {

using test::TempFolder;
using test::write_bytes;

/// The corners of the triangle, sorted.
std::vector<Vec3d> corners_at(const std::string& path, std::optional<double> seconds) {
  const Mesh mesh = read_mesh(path, {.seconds = seconds});
  std::vector<Vec3d> corners;
  for (const Vec3f& position : mesh.positions)
    corners.push_back(mesh.center + Vec3d(position));
  std::sort(corners.begin(), corners.end(),
            [](const Vec3d& a, const Vec3d& b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  return corners;
}

/// A node at x = 3 that moves to x = 13 in two seconds and turns by 90 degrees about z, and below
/// it one that grows to twice its size, with a triangle.
TEST(GltfMotion, NodesMoveTurnAndGrow) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  write_bytes(path, test::moving_triangle("LINEAR"));
  EXPECT_TRUE(is_animated_gltf(path));
  EXPECT_EQ(corners_at(path, std::nullopt)[0], Vec3d(3, 0, 0)); // at rest
  EXPECT_EQ(corners_at(path, -1)[0], Vec3d(3, 0, 0));           // as at the first key
  const auto middle = corners_at(path, 1);
  // Turned by 45 degrees, 1.5 times as large, at x = 8.
  const double share = 1.5 * std::numbers::sqrt2 / 2;
  ASSERT_EQ(middle.size(), 3u);
  EXPECT_NEAR(middle[0].x, 8 - share, 1e-5);
  EXPECT_NEAR(middle[0].y, share, 1e-5);
  EXPECT_NEAR(middle[2].x, 8 + share, 1e-5);
  const auto end = corners_at(path, 99);
  EXPECT_NEAR(end[0].x, 11, 1e-5);
  EXPECT_NEAR(end[2].y, 2, 1e-5);
  EXPECT_TRUE(read_mesh(path, {.seconds = 1}).notes.empty());
}

TEST(GltfMotion, WhatIsNotAppliedIsNoted) {
  const TempFolder folder;
  const std::string path = folder.file("a.gltf");
  write_bytes(path, test::moving_triangle("STEP"));
  ASSERT_EQ(read_mesh(path, {.seconds = 1}).notes.size(), 1u);
  EXPECT_NE(read_mesh(path, {.seconds = 1}).notes[0].find("steps or splines"), std::string::npos);
  EXPECT_TRUE(read_mesh(path).notes.empty()); // it rests
}

} // namespace
} // namespace vdbeam
