#pragma once

#include "vdbeam/image.h"

#include <string>

namespace vdbeam {

/// Lets a guarded child process (machine/guarded_process.h) run `read` on a picture that cannot be
/// trusted, and takes over what it read: whatever the file makes a decoder do, this process carries
/// on. Memory is bounded by what is free, time by the size of the file. Passes on the InputError of
/// `read`; throws it also where the decoder crashed or exceeded its limits.
Image read_guarded_picture(const std::string& path, Image (*read)(const std::string& path));

} // namespace vdbeam
