#pragma once

#include "lights/cone.h"
#include "lights/occupied_region.h"

namespace vdbeam {

/// The narrowest cone, about the way to the region's centre, that holds every box; all directions
/// where `position` lies among the boxes. Render space.
Cone cone_towards(const Vec3d& position, const OccupiedRegion& region);

/// Where a photon that leaves `position` outside the region's sphere enters the sphere; `position`
/// itself where it is inside. Far lights would lose all precision within a single-precision ray.
/// False where the way misses the sphere.
bool advance_to_region(const Vec3d& position, const Vec3d& direction, const OccupiedRegion& region,
                       Vec3d& origin);

} // namespace vdbeam
