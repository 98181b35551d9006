#pragma once

#include "vdbeam/render_plan.h"
#include "vdbeam/scene.h"

#include <vector>

namespace vdbeam {

/// The meshes and textures of a scene, each file once: of meshes the header, or the lines, are
/// looked at; pictures are read. Such as cannot be read are left out: the render will complain.
std::vector<SurfaceFile> surface_files(const Scene& scene);

} // namespace vdbeam
