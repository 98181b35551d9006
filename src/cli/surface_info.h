#pragma once

#include <string>

namespace vdbeam::cli {

/// Description of a mesh file for `vdbeam info`. Throws InputError and FrameError as reading it
/// does.
std::string mesh_info(const std::string& path);

/// Whether the name of a file says that it is a picture.
bool is_picture_file(const std::string& path);

/// Description of an image (a texture or a sky) for `vdbeam info`. Throws InputError.
std::string picture_info(const std::string& path);

} // namespace vdbeam::cli
