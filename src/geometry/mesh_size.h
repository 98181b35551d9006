#pragma once

#include <cstdint>
#include <string>

namespace vdbeam {

/// How much a mesh file holds, about, as its header or a quick look at its lines tells; 0 where
/// they cannot be read, which reading the mesh will complain about.
struct MeshSize {
  std::uint64_t vertices = 0, triangles = 0;
  bool normals = false; ///< some of its parts have them
};

MeshSize foretell_mesh(const std::string& path);

} // namespace vdbeam
