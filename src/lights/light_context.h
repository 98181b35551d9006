#pragma once

#include "lights/occupied_region.h"
#include "vdbeam/vec.h"
#include "volume/render_space.h"

#include <string>
#include <vector>

namespace vdbeam {

class Light;

/// Data of the scene for making a light.
struct LightContext {
  Vec3d up{0, 1, 0}; ///< the camera's, about which environment images turn
  const RenderSpace& space;
  const OccupiedRegion& region;              ///< lights copy what they need of it
  std::vector<std::string>* notes = nullptr; ///< for the user, one line each; are appended to
  /// The same light, made for another region, with which large tables may be shared; may be null.
  const Light* other = nullptr;
};

} // namespace vdbeam
