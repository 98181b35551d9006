#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// A mesh or texture of a scene, as its header tells.
struct SurfaceFile {
  std::string path;
  std::uint64_t triangles = 0; ///< of a mesh
  int width = 0, height = 0;   ///< of a texture
  std::uint64_t bytes = 0;     ///< of memory, about: the most that it takes, while it is read
};

/// Each file once. Such as cannot be read are left out: the render will complain.
std::vector<SurfaceFile> surface_files(const Scene& scene);

} // namespace vdbeam
