#pragma once

#include "vdbeam/image.h"
#include "vdbeam/scene.h"

#include <optional>
#include <string>

namespace vdbeam::cli {

/// The reference that an option names, which must have the picture's size, before any time goes
/// into rendering; none where `path` is empty. Only R, G and B are kept.
std::optional<Image> read_reference(const char* option, const std::string& path,
                                    const ImageSettings& size);

} // namespace vdbeam::cli
