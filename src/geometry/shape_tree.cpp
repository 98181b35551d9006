#include "geometry/shape_tree.h"

#include "machine/stop_reading.h"
#include "math/rng.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

namespace vdbeam {
namespace {

std::atomic<int> devices{0};

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& tree = *static_cast<const ShapeTree*>(args->geometryUserPtr);
  const Boxd box = tree.shape().bounds(args->primID);
  const auto down = [&](double x) {
    return std::nextafter(static_cast<float>(x - tree.margin()), -infinity);
  };
  const auto up = [&](double x) {
    return std::nextafter(static_cast<float>(x + tree.margin()), infinity);
  };
  *args->bounds_o = {down(box.lower.x), down(box.lower.y), down(box.lower.z), 0,
                     up(box.upper.x),   up(box.upper.y),   up(box.upper.z),   0};
}

/// Tests a primitive; true where it is the nearest so far. Of two at the same distance the one with
/// the lower numbers counts, whatever Embree's order.
bool test_primitive(unsigned primitive, Query& query) {
  const unsigned surface = query.context.instID[0];
  if (query.camera && !(*query.surfaces)[surface].surface.visible)
    return false;
  const double end = query.found == RTC_INVALID_GEOMETRY_ID
                         ? query.t_end
                         : std::nextafter(query.hit.t, static_cast<double>(infinity));
  const auto hit = query.meet(surface, primitive, end);
  if (!hit)
    return false;
  if (query.found != RTC_INVALID_GEOMETRY_ID && hit->t == query.hit.t &&
      std::pair(surface, primitive) > std::pair(query.found, query.found_primitive))
    return false;
  query.hit = *hit;
  query.found = surface;
  query.found_primitive = primitive;
  return true;
}

void intersect_shape(const RTCIntersectFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  if (!args->valid[0] || !test_primitive(args->primID, query))
    return;
  auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  ray.ray.tfar = std::min(ray.ray.tfar, query.embree_distance(query.hit.t));
  ray.hit.geomID = args->geomID;
  ray.hit.primID = args->primID;
  ray.hit.instID[0] = args->context->instID[0];
}

void occlude_shape(const RTCOccludedFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  if (args->valid[0] && test_primitive(args->primID, query))
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -infinity;
}

/// The same for the same ray and surface, so that each query of a ray finds the same holes; those
/// of other rays are independent.
float chance_of(const Query& query, unsigned surface, std::size_t primitive, int crossing) {
  std::uint64_t h =
      mix64((std::uint64_t(surface) << 32) + primitive) ^ static_cast<std::uint64_t>(crossing);
  for (const Vec3d& v : {query.origin, query.direction})
    for (const double x : {v.x, v.y, v.z})
      h = mix64(h + std::bit_cast<std::uint64_t>(x));
  return static_cast<float>(h >> 40) * 0x1p-24f;
}

} // namespace

std::optional<ShapeHit> Query::meet(unsigned surface, std::size_t primitive, double end) {
  enter(surface);
  const PlacedShape& placed = (*surfaces)[surface].surface;
  const Shape& shape = *placed.shape;
  constexpr int most_crossings = 4; // of a primitive, which is convex
  double begin = t_begin;
  for (int crossing = 0; crossing < most_crossings; ++crossing) {
    const auto met = shape.intersect(primitive, local_origin, local_direction, begin, end);
    if (!met || !placed.detail || !placed.detail->has_holes())
      return met;
    const Uv uv = shape.uv(primitive, local_origin + local_direction * met->t);
    if (placed.detail->stops(uv, chance_of(*this, surface, primitive, crossing)))
      return met;
    begin = met->t;
  }
  return std::nullopt;
}

DevicePtr make_device() {
  DevicePtr device(rtcNewDevice(nullptr), [](RTCDevice made) {
    if (made)
      rtcReleaseDevice(made);
  });
  if (!device)
    throw FrameError("Embree cannot be started");
  ++devices;
  return device;
}

int devices_made() {
  return devices;
}

void check(const DevicePtr& device) {
  const RTCError error = rtcGetDeviceError(device.get());
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw FrameError("the surfaces need more memory than there is");
  if (error != RTC_ERROR_NONE)
    throw FrameError("Embree cannot build its trees over the surfaces");
}

void commit(RTCScene scene, const DevicePtr& device) {
  const StopToken* stop = StopReading::token();
  if (stop)
    rtcSetSceneProgressMonitorFunction(
        scene, [](void* token, double) { return !static_cast<const StopToken*>(token)->stopped(); },
        const_cast<StopToken*>(stop));
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (stop && stop->stopped()) {
    (void)rtcGetDeviceError(device.get()); // is known, and no concern of later frames
    throw Stopped();
  }
  check(device);
}

ShapeTree::ShapeTree(DevicePtr device, std::shared_ptr<const Shape> shape, double margin)
    : shape_(std::move(shape)), margin_(margin), device_(std::move(device)) {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(shape_->primitives()));
  rtcSetGeometryUserData(geometry, this);
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { shape_bounds(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_shape);
  rtcCommitGeometry(geometry);
  scene_.reset(rtcNewScene(device_.get()));
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene_.get(), geometry);
  rtcReleaseGeometry(geometry);
  commit(scene_.get(), device_);
}

} // namespace vdbeam
