#pragma once

#include <cstdint>
#include <string>

namespace vdbeam {

/// Approximate size of a mesh file, from its header or a scan of its lines; 0 if they cannot be
/// read: reading the mesh reports that.
struct MeshSize {
  std::uint64_t vertices = 0, triangles = 0;
  bool normals = false; ///< some of its parts have them
};

MeshSize foretell_mesh(const std::string& path);

} // namespace vdbeam
