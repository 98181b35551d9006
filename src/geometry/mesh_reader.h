#pragma once

#include "geometry/mesh.h"
#include "machine/memory.h"

#include <cstdint>
#include <optional>
#include <string>

namespace vdbeam {

/// Limits of reading a mesh file.
struct MeshLimits {
  double seconds = 120; ///< of wall-clock time, beside what its size takes (time_for)
  std::uint64_t bytes = free_memory(); ///< of memory
};

/// Data of a mesh file to read beside its triangles.
struct MeshParts {
  bool uvs = false;     ///< the first texture coordinates, if all of its parts have them
  bool normals = false; ///< if some of its parts have them
  int material = -1;    ///< only triangles with this material of a glTF; -1: all
  std::optional<double> seconds = {}; ///< of the animation of a glTF's nodes; none: they rest
};

/// Whether the name of a file says that it is one that read_mesh reads.
bool is_mesh_file(const std::string& path);

/// Reads the triangles of an OBJ, PLY or glTF file, all of its nodes in their places at a time;
/// polygons are triangulated, lines and points left out. Skins and morph targets of a glTF are not
/// applied, which a note says. The file is parsed in a guarded child process
/// (machine/guarded_process.h). Throws InputError for what is no mesh file, FrameError for one that
/// is damaged.
Mesh read_mesh(const std::string& path, const MeshParts& parts = {}, const MeshLimits& limits = {});

} // namespace vdbeam
