#pragma once

#include "vdbeam/render.h"

#include <string>

namespace vdbeam {

/// Adds the attributes that describe a picture in its file: software, scene hash, settings, report
/// values, and the camera's worldToCamera and worldToNDC matrices as OpenEXR defines them.
void add_image_metadata(Image& image, const Scene& scene, const RenderResult& result,
                        const std::string& hash);

/// The picture's error estimate as attributes; what is unknown is left out.
void add_error_metadata(Image& image, const PassRecord& record);

} // namespace vdbeam
