#include "geometry/corner_normals.h"

#include "geometry/smooth_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

Vec3d flat_normal(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3d first(mesh.positions[a]);
  return normalize(cross(Vec3d(mesh.positions[b]) - first, Vec3d(mesh.positions[c]) - first));
}

/// The normal at unit length, or zero if it has no direction.
Vec3d unit_or_zero(const Vec3f& normal) {
  const Vec3d n(normal);
  const double size = length(n);
  return size > 0 && std::isfinite(size) ? n / size : Vec3d{};
}

bool is_missing(const Vec3f& normal) {
  return normal == Vec3f();
}

/// All corners of all triangles have the triangle's own normal, within four digits of a file.
/// A sphere's normals differ by more unless it has some hundred million triangles.
bool all_flat(const Mesh& mesh) {
  constexpr double farthest = 2e-4;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d flat = flat_normal(mesh, i);
    for (const Vec3f& normal : mesh.normals[i])
      if (length(Vec3d(normal) - flat) > farthest)
        return false;
  }
  return true;
}

} // namespace

void take_normals(const std::vector<Vec3f>& normals, const std::string& label, Mesh& mesh) {
  std::size_t missing = 0, reversed = 0;
  mesh.normals.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d flat = flat_normal(mesh, i);
    Vec3d corners[3];
    int to_front = 0, to_back = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = unit_or_zero(normals[mesh.triangles[i][k]]);
      missing += corners[k] == Vec3d{};
      to_front += dot(corners[k], flat) > 0;
      to_back += dot(corners[k], flat) < 0;
    }
    const bool turned = to_front == 0 && to_back > 0;
    reversed += turned;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d normal = turned ? -corners[k] : corners[k];
      const bool wrong = corners[k] != Vec3d{} && !(dot(normal, flat) > 0);
      mesh.normals[i][k] = Vec3f(wrong ? flat : normal);
    }
  }
  if (missing > 0)
    mesh.notes.push_back(
        fmt::format("{}: {} of {} triangle corners have no valid normal and are shaded without one",
                    label, missing, 3 * mesh.triangles.size()));
  if (reversed > 0)
    mesh.notes.push_back(fmt::format("{}: the normals of {} of {} triangles point to the back (by "
                                     "the vertex order) and are reversed",
                                     label, reversed, mesh.triangles.size()));
}

void complete_normals(Mesh& mesh, double degrees) {
  if (mesh.normals.empty() && degrees <= 0)
    return;
  std::vector<CornerNormals> smooth;
  if (degrees > 0)
    smooth = smooth_normals(mesh, degrees);
  if (mesh.normals.empty()) {
    mesh.normals = std::move(smooth);
    return;
  }
  for (std::size_t i = 0; i < mesh.normals.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      if (is_missing(mesh.normals[i][k]))
        mesh.normals[i][k] = smooth.empty() ? Vec3f(flat_normal(mesh, i)) : smooth[i][k];
  if (all_flat(mesh))
    mesh.normals = std::vector<CornerNormals>();
}

} // namespace vdbeam
