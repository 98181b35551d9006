#pragma once

#include "lights/occupied_region.h"
#include "vdbeam/vec.h"
#include "volume/render_space.h"

namespace vdbeam {

/// What a light must know of the scene to be made.
struct LightContext {
  Vec3d up{0, 1, 0}; ///< the camera's, about which environment images turn
  const RenderSpace& space;
  const OccupiedRegion& region; ///< lights copy what they need of it
};

} // namespace vdbeam
