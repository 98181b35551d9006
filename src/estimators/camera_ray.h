#pragma once

#include "math/rng.h"
#include "transport/world.h"

namespace vdbeam {

/// A camera ray, begun near the medium so that single precision serves a camera at any distance.
struct CameraRay {
  Ray ray;
  double shift = 0;  ///< distance from the camera to ray.origin
  float t_begin = 0; ///< part of the ray inside the medium's bounds; t_begin >= t_end: misses
  float t_end = 0;
};

inline CameraRay camera_ray(const World& world, const Camera& camera, double px, double py) {
  CameraRay result;
  const Vec3d direction = camera.direction(px, py);
  const Vec3d to_center = Vec3d(world.region.center) - camera.origin();
  result.shift = std::max(0.0, dot(to_center, direction) - 1.001 * world.region.radius);
  result.ray = {Vec3f(camera.origin() + direction * result.shift), Vec3f(direction)};
  result.t_end = world.medium.visible() ? infinity : 0;
  if (world.medium.visible())
    world.medium.clip(result.ray, result.t_begin, result.t_end);
  return result;
}

/// False only where no ray of the camera can meet the medium or what glows.
inline bool may_see_medium(const World& world, const Camera& camera) {
  const Boxf& box = world.medium.bounds;
  return world.medium.visible() && camera.may_see({Vec3d(box.lower), Vec3d(box.upper)});
}

} // namespace vdbeam
