#pragma once

#include "lights/occupied_region.h"
#include "vdbeam/vec.h"
#include "volume/render_space.h"

#include <string>
#include <vector>

namespace vdbeam {

/// What a light must know of the scene to be made.
struct LightContext {
  Vec3d up{0, 1, 0}; ///< the camera's, about which environment images turn
  const RenderSpace& space;
  const OccupiedRegion& region;              ///< lights copy what they need of it
  std::vector<std::string>* notes = nullptr; ///< takes what the user should know, one line each
};

} // namespace vdbeam
