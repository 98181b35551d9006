#pragma once

#include "vdbeam/scene.h"

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Where a camera stands and looks, in the world of the scene; unit vectors.
struct CameraPose {
  Vec3d position, forward, up;
  std::optional<double> fov;  ///< vertical, degrees
  double first = 0, last = 0; ///< frames of the file; the same where the camera stands still
};

/// The camera file of a scene, as it was read last: the moments of a shutter and the frames of a
/// sequence read it once, unless it changes meanwhile. May be used by several threads.
///
/// Files are of Nuke's .chan format (frame, translation, three angles in degrees, vertical field of
/// view), a 4 x 4 matrix from the camera to the world per line, after the frame's number or alone,
/// or a camera of a glTF file. Cameras look along their -Z axis, +Y being up. Between frames
/// everything is interpolated linearly; before the first and after the last it holds.
class CameraFile {
public:
  /// The camera of settings.file at a time [frames]. Throws InputError with file and line.
  CameraPose pose_at(const CameraSettings& settings, double time);

  /// One frame, and what the file says of it.
  struct Key {
    double frame = 0;
    std::vector<double> values; ///< 6 or 7 of a .chan file, or a matrix
    int line = 0;               ///< 0: the file has none
  };
  struct Track {
    std::vector<Key> keys;     ///< in ascending order of their frames
    bool matrices = false;     ///< the keys hold matrices ...
    bool rows = false;         ///< ... that act on row vectors
    std::optional<double> fov; ///< vertical [degrees], of all keys; none: as the keys have it
  };

private:
  std::mutex mutex_;
  std::string identity_; ///< of what was read
  std::shared_ptr<const Track> track_;
};

} // namespace vdbeam
