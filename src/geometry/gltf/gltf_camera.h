#pragma once

#include "math/affine.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// How a camera of a glTF file moves. It looks along its -Z axis, +Y being up.
struct CameraTrack {
  struct Key {
    double seconds = 0; ///< ascending
    Affine to_world;    ///< from the camera
  };
  std::vector<Key> keys;     ///< one where it stands still
  std::optional<double> fov; ///< vertical [degrees]; none: it is orthographic
};

/// Whether the name of a file says that it is glTF.
bool is_gltf_file(const std::string& path);

/// Reads the camera of a glTF file whose node has this name, or its first where `name` is empty.
/// Animated nodes, and those that they hang from, are sampled at their keys and `rate` times per
/// second in between. The file is parsed in a guarded child process. Throws InputError where there
/// is no such camera, FrameError for a damaged file.
CameraTrack read_gltf_camera(const std::string& path, const std::string& name, double rate);

} // namespace vdbeam
