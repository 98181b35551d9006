#pragma once

#include "math/stop_token.h"
#include "report/frame_files.h"
#include "vdbeam/image.h"
#include "vdbeam/scene.h"

#include <optional>
#include <string>

namespace vdbeam::cli {

/// The reference that an option names, which must have the picture's size, before any time goes
/// into rendering; none where `path` is empty. Only R, G and B are kept.
std::optional<Image> read_reference(const char* option, const std::string& path,
                                    const ImageSettings& size);

struct References {
  std::optional<Image> first, second;
};

/// Those that a render's options name for a frame; nothing where `stop` ended it. Throws as
/// read_reference.
std::optional<References> read_references(const FrameFiles& files, int frame,
                                          const ImageSettings& size, const StopToken& stop);

} // namespace vdbeam::cli
