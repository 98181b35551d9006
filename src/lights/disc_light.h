#pragma once

#include "lights/light.h"
#include "lights/occupied_region.h"

#include <memory>

namespace vdbeam {

/// A disc of light beyond the scene. `direction`: unit, the way its light travels; `irradiance` on
/// a plane that faces it; its radius as an angle in degrees, in (0, 90]. `limb`: its radiance is as
/// cos(a)^limb where its surface, a ball's, is seen at the angle a to its normal; 0: even.
std::unique_ptr<Light> make_disc_light(const Vec3d& direction, const Rgb& irradiance,
                                       double radius_degrees, const Rgb& limb,
                                       const OccupiedRegion& region);

} // namespace vdbeam
