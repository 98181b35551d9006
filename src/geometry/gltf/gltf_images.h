#pragma once

#include "vdbeam/image.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace vdbeam {

/// A picture that a glTF names.
struct GltfPicture {
  std::string file;  ///< of the picture, or the glTF itself; empty: none that can be read
  int image = -1;    ///< its number in the glTF, which holds it; -1: a file of its own
  std::string issue; ///< why it cannot be read
};

/// Where a picture of a glTF lies: an element of its list of images.
GltfPicture find_gltf_picture(const std::string& path, const nlohmann::json& image, int index);

/// Reads a picture that a .gltf or .glb file holds (in a buffer, or as a data: URI). It is parsed
/// in guarded child processes. Throws InputError.
Image read_gltf_image(const std::string& path, int index);

/// Reads a picture. Throws InputError.
Image read_picture(const GltfPicture& picture);

/// Whether the numbers of a picture were read as sRGB colours, as those of PNG and JPEG are.
bool is_encoded(const GltfPicture& picture);

} // namespace vdbeam
