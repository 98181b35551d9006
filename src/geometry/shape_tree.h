#pragma once

#include "geometry/placed.h"

#include <embree3/rtcore.h>

#include <memory>

namespace vdbeam {

/// Embree's device, which trees and the sets of surfaces that use them share.
using DevicePtr = std::shared_ptr<RTCDeviceTy>;

struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneDeleter>;

/// Throws FrameError where Embree cannot be started.
DevicePtr make_device();
/// Devices made so far by this process.
int devices_made();
/// Throws FrameError for what the device could not do.
void check(const DevicePtr& device);

/// Builds the scene's tree. Throws FrameError for what the device cannot do, and Stopped
/// (StopReading).
void commit(RTCScene scene, const DevicePtr& device);

/// Embree's tree over a shape in its own space: instances share it, and so do the surfaces of other
/// frames and moments in which the shape is the same, wherever it stands. Immutable.
class ShapeTree {
public:
  /// `margin`: by how much boxes are wider than what they hold, since Embree has rounded the rays.
  /// What a ray meets does not depend on it, as long as it is no less than the rounding.
  ShapeTree(DevicePtr device, std::shared_ptr<const Shape> shape, double margin);
  ShapeTree(const ShapeTree&) = delete; // Embree has its address
  ShapeTree& operator=(const ShapeTree&) = delete;

  const Shape& shape() const { return *shape_; }
  double margin() const { return margin_; }
  RTCScene scene() const { return scene_.get(); }

private:
  std::shared_ptr<const Shape> shape_;
  double margin_;
  DevicePtr device_; // outlives the scene
  ScenePtr scene_;
};

/// One query; Embree hands its first part on to the callbacks.
struct Query {
  RTCIntersectContext context; // must come first
  const std::vector<Placed>* surfaces = nullptr;
  Vec3d origin, direction;
  double t_begin = 0, t_end = 0, shift = 0;
  bool camera = false, any = false;
  unsigned local_of = RTC_INVALID_GEOMETRY_ID; ///< surface whose space `local_...` are in
  Vec3d local_origin, local_direction;
  unsigned found = RTC_INVALID_GEOMETRY_ID, found_primitive = 0;
  ShapeHit hit;

  Query(const Vec3d& from, const Vec3d& along, double begin, double end)
      : origin(from), direction(along), t_begin(begin), t_end(end) {}

  void enter(unsigned surface) {
    if (surface == local_of)
      return;
    const Affine& map = (*surfaces)[surface].place.to_shape;
    local_of = surface;
    local_origin = map.point(origin);
    local_direction = map.vector(direction);
  }
  /// Where the ray meets a primitive of a surface, not in a hole of it, before a distance.
  std::optional<ShapeHit> meet(unsigned surface, std::size_t primitive, double end);
  /// Embree's distance for one of the given ray, rounded up.
  float embree_distance(double t) const {
    return std::nextafter(static_cast<float>(t - shift), infinity);
  }
};

} // namespace vdbeam
