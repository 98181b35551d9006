#include "geometry/surface_set.h"

#include "geometry/placed.h"
#include "vdbeam/error.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

namespace vdbeam {
namespace {

std::atomic<int> devices{0};

struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
using ScenePtr = std::unique_ptr<RTCSceneTy, SceneDeleter>;
using DevicePtr = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;

/// A shape as Embree's callbacks see it.
struct ShapeEntry {
  const Shape* shape = nullptr;
  double margin = 0; ///< of the boxes, for rays that Embree has rounded
  ScenePtr scene;
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
  /// Embree's distance for one of the given ray, rounded up.
  float embree_distance(double t) const {
    return std::nextafter(static_cast<float>(t - shift), infinity);
  }
};

void shape_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& entry = *static_cast<const ShapeEntry*>(args->geometryUserPtr);
  const Boxd box = entry.shape->bounds(args->primID);
  const auto down = [&](double x) {
    return std::nextafter(static_cast<float>(x - entry.margin), -infinity);
  };
  const auto up = [&](double x) {
    return std::nextafter(static_cast<float>(x + entry.margin), infinity);
  };
  *args->bounds_o = {down(box.lower.x), down(box.lower.y), down(box.lower.z), 0,
                     up(box.upper.x),   up(box.upper.y),   up(box.upper.z),   0};
}

/// Tests a primitive; true where it is the nearest so far. Of two at the same distance the one with
/// the lower numbers counts, whatever Embree's order.
bool test_primitive(const ShapeEntry& entry, unsigned primitive, Query& query) {
  const unsigned surface = query.context.instID[0];
  if (query.camera && !(*query.surfaces)[surface].surface.visible)
    return false;
  query.enter(surface);
  const double end = query.found == RTC_INVALID_GEOMETRY_ID
                         ? query.t_end
                         : std::nextafter(query.hit.t, static_cast<double>(infinity));
  const auto hit = entry.shape->intersect(primitive, query.local_origin, query.local_direction,
                                          query.t_begin, end);
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
  const auto& entry = *static_cast<const ShapeEntry*>(args->geometryUserPtr);
  if (!args->valid[0] || !test_primitive(entry, args->primID, query))
    return;
  auto& ray = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  ray.ray.tfar = std::min(ray.ray.tfar, query.embree_distance(query.hit.t));
  ray.hit.geomID = args->geomID;
  ray.hit.primID = args->primID;
  ray.hit.instID[0] = args->context->instID[0];
}

void occlude_shape(const RTCOccludedFunctionNArguments* args) {
  auto& query = *reinterpret_cast<Query*>(args->context);
  const auto& entry = *static_cast<const ShapeEntry*>(args->geometryUserPtr);
  if (args->valid[0] && test_primitive(entry, args->primID, query))
    reinterpret_cast<RTCRay*>(args->ray)->tfar = -infinity;
}

/// A search for the nearest surface.
struct Nearest {
  const std::vector<Placed>* surfaces;
  Vec3d point;
  double distance;
};

/// Takes a primitive into account; true where Embree need not look as far any more.
bool approach_primitive(RTCPointQueryFunctionArguments* args) {
  auto& nearest = *static_cast<Nearest*>(args->userPtr);
  const Placed& entry = (*nearest.surfaces)[args->context->instID[0]];
  const double distance = entry.surface.shape->distance(args->primID, nearest.point, entry.place);
  if (!(distance < nearest.distance))
    return false;
  nearest.distance = distance;
  // Embree's radius is one of the shape's own space, unless that is stretched unevenly.
  const double scale = args->similarityScale > 0 ? entry.place.most_shrink : 1;
  const float radius = std::nextafter(static_cast<float>(distance * scale * (1 + 1e-5)), infinity);
  if (!(radius < args->query->radius))
    return false;
  args->query->radius = radius;
  return true;
}

void check(RTCDevice device) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_OUT_OF_MEMORY)
    throw FrameError("the surfaces need more memory than there is");
  if (error != RTC_ERROR_NONE)
    throw FrameError("Embree cannot build its trees over the surfaces");
}

} // namespace

struct SurfaceSet::Data {
  DevicePtr device;
  std::vector<Placed> surfaces;
  std::map<const Shape*, ShapeEntry> shapes;
  ScenePtr scene;
  Boxd bounds;
  std::size_t bytes = 0;

  void place(std::vector<PlacedShape>&& placed);
  void build_shape(ShapeEntry& entry);
  void build(double reach);
  void run(Query& query) const;
};

void SurfaceSet::Data::place(std::vector<PlacedShape>&& placed) {
  for (PlacedShape& surface : placed) {
    Placed entry{std::move(surface), {}, {}};
    const Shape& shape = *entry.surface.shape;
    entry.place = ShapePlace::at(entry.surface.to_render);
    entry.bounds = mapped(entry.surface.to_render, shape.bounds());
    bounds.extend(entry.bounds);
    surfaces.push_back(std::move(entry));
    shapes[&shape].shape = &shape;
  }
}

void SurfaceSet::Data::build_shape(ShapeEntry& entry) {
  RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(entry.shape->primitives()));
  rtcSetGeometryUserData(geometry, &entry);
  rtcSetGeometryBoundsFunction(
      geometry, [](const RTCBoundsFunctionArguments* args) { shape_bounds(args); }, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_shape);
  rtcCommitGeometry(geometry);
  entry.scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(entry.scene.get(), RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(entry.scene.get(), geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(entry.scene.get());
  check(device.get());
}

void SurfaceSet::Data::build(double reach) {
  device.reset(rtcNewDevice(nullptr));
  if (!device)
    throw FrameError("Embree cannot be started");
  ++devices;
  // Embree rounds rays to single precision in each shape's own space; boxes are wider by as much,
  // but never by so much that they hold nothing out.
  constexpr double rounding = 1e-6, widest = 0.01;
  for (const Placed& entry : surfaces) {
    ShapeEntry& shape = shapes[entry.surface.shape.get()];
    const double size = length(entry.surface.shape->bounds().size());
    const double local_reach = reach / least_stretch(entry.place.to_shape) + size;
    shape.margin = std::max(shape.margin, std::min(rounding * local_reach, widest * size));
  }
  for (auto& [shape, entry] : shapes)
    build_shape(entry);
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    RTCGeometry instance = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    const Affine& map = surfaces[i].surface.to_render;
    float matrix[12];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        matrix[4 * row + column] = static_cast<float>(map.rows[row][column]);
      matrix[4 * row + 3] = static_cast<float>(map.translation[row]);
    }
    rtcSetGeometryInstancedScene(instance, shapes[surfaces[i].surface.shape.get()].scene.get());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene.get(), instance, static_cast<unsigned>(i));
    rtcReleaseGeometry(instance);
  }
  rtcCommitScene(scene.get());
  check(device.get());
}

void SurfaceSet::Data::run(Query& query) const {
  rtcInitIntersectContext(&query.context);
  query.surfaces = &surfaces;
  // A far origin is moved up to the surfaces.
  const Vec3d center = bounds.center();
  const double radius = 0.5 * length(bounds.size());
  const double along = dot(center - query.origin, query.direction);
  query.shift = std::max(query.t_begin, along - 1.01 * radius);
  const Vec3d start = query.origin + query.direction * query.shift;
  RTCRayHit ray{};
  ray.ray.org_x = static_cast<float>(start.x);
  ray.ray.org_y = static_cast<float>(start.y);
  ray.ray.org_z = static_cast<float>(start.z);
  ray.ray.dir_x = static_cast<float>(query.direction.x);
  ray.ray.dir_y = static_cast<float>(query.direction.y);
  ray.ray.dir_z = static_cast<float>(query.direction.z);
  ray.ray.tnear = 0;
  ray.ray.tfar = query.embree_distance(query.t_end);
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (!(ray.ray.tfar > 0))
    return;
  if (query.any)
    rtcOccluded1(scene.get(), &query.context, &ray.ray);
  else
    rtcIntersect1(scene.get(), &query.context, &ray);
}

SurfaceSet::SurfaceSet(std::vector<PlacedShape> surfaces, double reach)
    : data_(std::make_unique<Data>()) {
  data_->place(std::move(surfaces));
  const Boxd& box = data_->bounds;
  const double coordinate = std::max(length(box.lower), length(box.upper));
  data_->build(reach + coordinate + length(box.size()));
  // Embree's trees over user geometry take about 60 bytes per primitive.
  constexpr std::size_t tree_bytes = 60;
  for (const auto& [shape, entry] : data_->shapes)
    data_->bytes += shape->bytes() + tree_bytes * shape->primitives();
}

SurfaceSet::~SurfaceSet() = default;

std::optional<SurfaceHit> SurfaceSet::intersect(const Vec3d& origin, const Vec3d& direction,
                                                double t_begin, double t_end, bool camera) const {
  Query query(origin, direction, t_begin, t_end);
  query.camera = camera;
  data_->run(query);
  if (query.found == RTC_INVALID_GEOMETRY_ID)
    return std::nullopt;
  SurfaceHit hit;
  hit.t = query.hit.t;
  hit.position = origin + direction * hit.t;
  hit.normal = Vec3f(data_->surfaces[query.found].normal(query.hit.normal));
  hit.surface = static_cast<int>(query.found);
  hit.primitive = query.found_primitive;
  if (data_->surfaces[query.found].surface.textured)
    hit.uv = uv(hit);
  return hit;
}

bool SurfaceSet::occluded(const Vec3d& origin, const Vec3d& direction, double t_begin,
                          double t_end) const {
  Query query(origin, direction, t_begin, t_end);
  query.any = true;
  data_->run(query);
  return query.found != RTC_INVALID_GEOMETRY_ID;
}

double SurfaceSet::distance(const Vec3d& point, double most) const {
  Nearest nearest{&data_->surfaces, point, most};
  RTCPointQuery query{static_cast<float>(point.x), static_cast<float>(point.y),
                      static_cast<float>(point.z), 0,
                      std::nextafter(static_cast<float>(most * (1 + 1e-5)), infinity)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(data_->scene.get(), &query, &context, approach_primitive, &nearest);
  return nearest.distance;
}

std::size_t SurfaceSet::size() const {
  return data_->surfaces.size();
}
const Boxd& SurfaceSet::bounds() const {
  return data_->bounds;
}
Boxd SurfaceSet::bounds(std::size_t surface) const {
  return data_->surfaces[surface].bounds;
}
std::size_t SurfaceSet::bytes() const {
  return data_->bytes;
}
double SurfaceSet::area(std::size_t surface) const {
  // Areas of stretched shapes have no closed form in general: the mean over points of the shape.
  const Placed& entry = data_->surfaces[surface];
  const Shape& shape = *entry.surface.shape;
  constexpr int points = 64;
  double sum = 0;
  for (int i = 0; i < points * points; ++i) {
    const double u = (i % points + 0.5) / points, v = (i / points + 0.5) / points;
    sum += entry.stretch(shape.sample((i + 0.5) / (points * points), u, v).normal);
  }
  return shape.area() * sum / (points * points);
}

SurfacePoint SurfaceSet::sample(std::size_t surface, double u_primitive, double u, double v) const {
  const Placed& entry = data_->surfaces[surface];
  return entry.placed(entry.surface.shape->sample(u_primitive, u, v));
}

std::size_t SurfaceSet::primitives(std::size_t surface) const {
  return data_->surfaces[surface].surface.shape->primitives();
}

double SurfaceSet::share_before(std::size_t surface, std::size_t primitive) const {
  const Shape& shape = *data_->surfaces[surface].surface.shape;
  return shape.area_before(primitive) / shape.area();
}

SurfacePoint SurfaceSet::sample(std::size_t surface, std::size_t primitive,
                                const AreaPlace& place) const {
  const Placed& entry = data_->surfaces[surface];
  const ShapePoint point = entry.surface.shape->sample(primitive, place);
  SurfacePoint result = entry.placed(point);
  if (entry.surface.textured)
    result.uv = entry.surface.shape->uv(primitive, point.position);
  return result;
}

Uv SurfaceSet::uv(const SurfaceHit& hit) const {
  const Placed& entry = data_->surfaces[static_cast<std::size_t>(hit.surface)];
  return entry.surface.shape->uv(hit.primitive, entry.place.to_shape.point(hit.position));
}

AreaPlace SurfaceSet::place_of(std::size_t surface, std::size_t primitive,
                               const Vec3d& point) const {
  const Placed& entry = data_->surfaces[surface];
  return entry.surface.shape->place_of(primitive, entry.place.to_shape.point(point));
}

float SurfaceSet::sample_pdf(std::size_t surface, const Vec3f& normal) const {
  const Placed& entry = data_->surfaces[surface];
  // The normal in the shape's space: covectors map back by the transposed map.
  const Affine& map = entry.surface.to_render;
  const Vec3d n(normal);
  const Vec3d local = map.rows[0] * n.x + map.rows[1] * n.y + map.rows[2] * n.z;
  return static_cast<float>(1 / (entry.surface.shape->area() * entry.stretch(local)));
}

int SurfaceSet::devices_made() {
  return devices;
}

} // namespace vdbeam
