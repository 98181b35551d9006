#pragma once

#include "vdbeam/image.h"

#include <string>

namespace vdbeam::cli {

/// Packets of tev's protocol: the length of the packet as 32 bits, itself included, the kind as one
/// byte, then the fields; numbers are little-endian, texts end with a 0.

/// Creates an empty image with the channels of `image` (CreateImage).
std::string create_packet(const std::string& name, const Image& image);

/// The values of one channel of `image` (UpdateImageV3).
std::string update_packet(const std::string& name, const Image& image, const ImageChannel& channel);

} // namespace vdbeam::cli
