#pragma once

#include "vdbeam/scene.h"

#include <optional>

namespace vdbeam {

/// Where a camera stands and looks, in the world of the scene; unit vectors.
struct CameraPose {
  Vec3d position, forward, up;
  std::optional<double> fov; ///< vertical, degrees
};

/// The camera of settings.file at a time [frames]: of Nuke's .chan format (frame, translation,
/// three angles in degrees, vertical field of view), a 4 x 4 matrix from the camera to the world
/// per line, after the frame's number or alone, or a camera of a glTF file. Cameras look along
/// their -Z axis, +Y being up. Between frames everything is interpolated linearly; before the first
/// and after the last it holds. Throws InputError with file and line.
CameraPose read_camera_file(const CameraSettings& settings, double time);

} // namespace vdbeam
