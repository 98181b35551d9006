#pragma once

#include "lights/cone.h"
#include "lights/occupied_region.h"

namespace vdbeam {

/// The narrowest cone, about the way to the region's centre, that holds every box; all directions
/// where `position` lies among the boxes. Render space.
Cone cone_towards(const Vec3d& position, const OccupiedRegion& region);

/// The point where a photon that starts at `position` outside the region's sphere enters the
/// sphere; `position` itself where it is inside. A single-precision ray from a far light would lose
/// all precision. False where the photon misses the sphere.
bool advance_to_region(const Vec3d& position, const Vec3d& direction, const OccupiedRegion& region,
                       Vec3d& origin);

} // namespace vdbeam
