#pragma once

#include "vdbeam/image.h"

#include <string>

namespace vdbeam {

/// Names the image's layers as another renderer does: "arnold" or "cycles"
/// (docs/reference/output.md); layers that it does not have keep their names.
void rename_layers(Image& image, const std::string& renderer);

/// The other way, for the colours and alpha of a file of Cycles, unless the image has its own.
void name_combined_rgba(Image& image);

} // namespace vdbeam
