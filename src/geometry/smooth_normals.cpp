#include "geometry/smooth_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vdbeam {
namespace {

/// Around a point where more triangles meet they stay flat: each is compared with each.
constexpr std::size_t most_triangles = 256;

/// A corner of a triangle: its number is three times that of the triangle and that of the vertex.
using Corner = std::size_t;

bool before(const Vec3f& a, const Vec3f& b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// All corners, those at the same place together: files have several vertices where texture
/// coordinates end.
std::vector<Corner> by_place(const Mesh& mesh) {
  std::vector<Corner> corners(3 * mesh.triangles.size());
  std::iota(corners.begin(), corners.end(), Corner(0));
  const auto place = [&](Corner c) { return mesh.positions[mesh.triangles[c / 3][c % 3]]; };
  std::sort(corners.begin(), corners.end(), [&](Corner a, Corner b) {
    const Vec3f p = place(a), q = place(b);
    return before(p, q) || (!before(q, p) && a < b);
  });
  return corners;
}

} // namespace

std::vector<CornerNormals> smooth_normals(const Mesh& mesh, double degrees) {
  std::vector<Vec3f> flat(mesh.triangles.size());
  std::vector<std::array<float, 3>> angles(flat.size());
  const auto position = [&](Corner c) {
    return Vec3d(mesh.positions[mesh.triangles[c / 3][c % 3]]);
  };
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const Vec3d p[3] = {position(3 * i), position(3 * i + 1), position(3 * i + 2)};
    flat[i] = Vec3f(normalize(cross(p[1] - p[0], p[2] - p[0])));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d a = p[(k + 1) % 3] - p[k], b = p[(k + 2) % 3] - p[k];
      angles[i][k] = static_cast<float>(std::atan2(length(cross(a, b)), dot(a, b)));
    }
  }
  const auto least = static_cast<float>(std::cos(degrees * std::numbers::pi / 180) - 1e-6);
  std::vector<CornerNormals> normals(flat.size());
  const std::vector<Corner> corners = by_place(mesh);
  for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
    while (end < corners.size() && position(corners[end]) == position(corners[begin]))
      ++end;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f& own = flat[corners[i] / 3];
      Vec3f sum;
      for (std::size_t j = begin; j < end && end - begin <= most_triangles; ++j) {
        const Corner c = corners[j];
        if (dot(flat[c / 3], own) >= least)
          sum += flat[c / 3] * angles[c / 3][c % 3];
      }
      normals[corners[i] / 3][corners[i] % 3] = dot(sum, own) > 0 ? normalize(sum) : own;
    }
  }
  return normals;
}

} // namespace vdbeam
