#pragma once

#include "vdbeam/scene.h"

#include <functional>

namespace vdbeam {

/// Moments of the shutter's time at which volumes and lights are seen.
int shutter_times(const CameraSettings& camera);

/// Fills scene.moments where its shutter is open for some time and something moves: keys that are
/// animated (`animated`), or volumes that may have velocities. `scene_at` gives the scene at
/// another time [frames]. Moments lie in the middles of equal parts of the shutter's time; cameras
/// move in finer steps than all else, since a new camera costs nothing and a new world does.
void add_moments(Scene& scene, bool animated, const std::function<Scene(double time)>& scene_at);

} // namespace vdbeam
