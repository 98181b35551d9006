#pragma once

#include <string>

namespace vdbeam::cli {

/// What `vdbeam info` tells of a mesh file. Throws InputError and FrameError as reading it does.
std::string mesh_info(const std::string& path);

/// Whether the name of a file says that it is a picture.
bool is_picture_file(const std::string& path);

/// What `vdbeam info` tells of a picture: a texture, or a sky. Throws InputError.
std::string picture_info(const std::string& path);

} // namespace vdbeam::cli
