#pragma once

#include "vdbeam/render.h"

#include <string>

namespace vdbeam {

/// Adds what a picture's file should tell about it: software, scene hash, settings, report values,
/// and the camera's worldToCamera and worldToNDC matrices as OpenEXR defines them.
void add_image_metadata(Image& image, const Scene& scene, const RenderResult& result, int frame,
                        const std::string& hash);

} // namespace vdbeam
