#pragma once

#include "math/affine.h"
#include "math/uv.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// Unit vectors at the corners of a triangle.
using CornerNormals = std::array<Vec3f, 3>;

/// Triangles. Positions are relative to `center`, so that single precision loses nothing where a
/// mesh was modelled far from its origin.
struct Mesh {
  Vec3d center;
  std::vector<Vec3f> positions;
  std::vector<Uv> uvs;                                 ///< per position, or none
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< counter-clockwise seen from outside
  /// Per triangle, of the surface that it stands for, or none; zero at corners for which the file
  /// gives no normal (geometry/corner_normals.h).
  std::vector<CornerNormals> normals;
  std::vector<std::string> notes; ///< for the user: repairs

  std::size_t bytes() const {
    return positions.size() * sizeof(Vec3f) + uvs.size() * sizeof(Uv) +
           triangles.size() * sizeof triangles[0] + normals.size() * sizeof normals[0];
  }
};

/// Triangles as a file has them: nothing in it is checked yet.
struct RawMesh {
  std::vector<Vec3d> positions;
  std::vector<Uv> uvs;        ///< one per position, or none
  std::vector<Vec3f> normals; ///< one per position, of any length, zero if missing; or none
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Drops triangles that have an index beyond the vertices, a vertex that is not finite, or no area,
/// and reports them in the notes; recentres the rest. Invalid normals become zero and are
/// reported too. Throws FrameError where no triangle is left.
Mesh repair_mesh(const RawMesh& raw, const std::string& label);

} // namespace vdbeam
