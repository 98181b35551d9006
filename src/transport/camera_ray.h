#pragma once

#include "math/rng.h"
#include "transport/world.h"

namespace vdbeam {

/// A camera ray that starts near the medium, so that single precision suffices for far cameras.
struct CameraRay {
  Segment segment;  ///< the part inside the medium's bounds; empty where the ray misses them
  double shift = 0; ///< distance from the camera to segment.ray.origin
  std::optional<SurfaceHit> hit; ///< the surface at which it ends; t from the camera
  RayAir air;                    ///< between the camera and what it sees; none beyond mirrors

  const Ray& ray() const { return segment.ray; }
  /// From the camera to where the ray meets a surface or leaves the scene.
  Segment whole() const {
    return {segment.ray, static_cast<float>(-shift),
            hit ? static_cast<float>(hit->t - shift) : infinity};
  }
};

/// What the air does to light from the end of a ray.
inline RayAir::Seen air_to_end(const CameraRay& camera) {
  return camera.air ? camera.air.at(camera.whole().t_end) : RayAir::Seen();
}

inline CameraRay camera_ray(const World& world, const Camera& camera, const EyeRay& eye) {
  CameraRay result;
  const Vec3d to_center = Vec3d(world.region.center) - eye.origin;
  result.shift = std::max(0.0, dot(to_center, eye.direction) - 1.001 * world.region.radius);
  result.segment.ray = {Vec3f(eye.origin + eye.direction * result.shift), Vec3f(eye.direction)};
  if (world.medium.visible())
    result.segment = world.medium.clip(result.segment);
  else
    result.segment.t_end = 0;
  if (world.air)
    result.air = world.air->along(eye.direction, result.shift);
  double nearest = 0, farthest = static_cast<double>(infinity);
  if (camera.clips()) {
    nearest = camera.nearest(eye.direction);
    farthest = camera.farthest(eye.direction);
    Segment& s = result.segment;
    s.t_begin = std::max(s.t_begin, static_cast<float>(nearest - result.shift));
    s.t_end = std::min(s.t_end, static_cast<float>(farthest - result.shift));
  }
  if (world.surfaces) {
    result.hit = world.surfaces->set->intersect(eye.origin, eye.direction, nearest, farthest, true);
    const bool in_medium =
        !result.hit || world.surfaces->medium_end(result.hit, result.segment.ray.direction) > 0;
    result.segment.t_end =
        in_medium ? std::min(result.segment.t_end, result.whole().t_end) : result.segment.t_begin;
  }
  return result;
}

/// The ray that leaves a surface, up to the next.
inline CameraRay ray_from_surface(const World& world, const Vec3d& origin, const Vec3f& direction) {
  CameraRay ray;
  ray.segment = flight_segment(world, origin, direction, ray.hit);
  if (world.medium.visible())
    ray.segment = world.medium.clip(ray.segment);
  else
    ray.segment.t_end = 0;
  return ray;
}

/// False only where no ray of the camera can meet the medium or an emitting volume.
inline bool may_see_medium(const World& world, const Camera& camera) {
  const Boxf& box = world.medium.bounds;
  return world.medium.visible() && camera.may_see({Vec3d(box.lower), Vec3d(box.upper)});
}

} // namespace vdbeam
