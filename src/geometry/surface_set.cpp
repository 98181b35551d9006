#include "geometry/surface_set.h"

#include "geometry/shape_tree.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace vdbeam {
namespace {

/// A search for the nearest surface.
struct Nearest {
  const std::vector<Placed>* surfaces;
  Vec3d point;
  double distance;
  unsigned skipped; ///< surface that does not count
};

float radius_of(double distance) {
  return std::nextafter(static_cast<float>(distance * (1 + 1e-5)), infinity);
}

/// Takes a primitive into account; true where Embree need not look as far any more.
bool approach_primitive(RTCPointQueryFunctionArguments* args) {
  auto& nearest = *static_cast<Nearest*>(args->userPtr);
  const unsigned surface = args->context->instID[0];
  if (surface == nearest.skipped)
    return false;
  const Placed& entry = (*nearest.surfaces)[surface];
  const double distance = entry.surface.shape->distance(args->primID, nearest.point, entry.place);
  nearest.distance = std::min(nearest.distance, distance);
  // The radius is that of the query as it was asked, not one of the shape's own space.
  const float radius = radius_of(nearest.distance);
  if (!(radius < args->query->radius))
    return false;
  args->query->radius = radius;
  return true;
}

} // namespace

struct SurfaceSet::Data {
  DevicePtr device; ///< null where all surfaces are planes
  std::vector<Placed> surfaces;
  std::vector<unsigned> planes; ///< surfaces without an end, which stand in no tree
  std::map<const Shape*, std::shared_ptr<const ShapeTree>> trees;
  ScenePtr scene;
  Boxd bounds;
  Vec3d center;           ///< of the bounds
  double ball_radius = 0; ///< radius of the ball around them
  double most_shrink = 1; ///< of the surfaces' places, and at least 1
  std::size_t bytes = 0;
  int trees_built = 0;

  void place(std::vector<PlacedShape>&& placed);
  void bound_planes(double reach);
  void grow_trees(double reach, const Data* previous);
  void build_scene();
  bool meet_planes(Query& query) const;
  void run(Query& query) const;
  double distance(const Vec3d& point, double most,
                  unsigned skipped = RTC_INVALID_GEOMETRY_ID) const;
};

void SurfaceSet::Data::place(std::vector<PlacedShape>&& placed) {
  for (PlacedShape& surface : placed) {
    Placed entry{std::move(surface), {}, {}};
    const Shape& shape = *entry.surface.shape;
    entry.place = ShapePlace::at(entry.surface.to_render);
    if (shape.is_infinite()) {
      planes.push_back(static_cast<unsigned>(surfaces.size()));
    } else {
      entry.bounds = mapped(entry.surface.to_render, shape.bounds());
      bounds.extend(entry.bounds);
      most_shrink = std::max(most_shrink, entry.place.most_shrink);
    }
    surfaces.push_back(std::move(entry));
  }
  center = bounds.center();
  ball_radius = 0.5 * length(bounds.size());
}

/// What lights aim photons at: of an evenly lit plane, all but this part of the light that it sends
/// to a point at the distance h comes from within h / part.
void SurfaceSet::Data::bound_planes(double reach) {
  constexpr double part = 5e-5;
  for (const unsigned i : planes) {
    Placed& entry = surfaces[i];
    const Vec3d normal = entry.normal({0, 0, 1});
    const Vec3d foot = normal * dot(normal, entry.surface.to_render.translation);
    const double radius = (reach + length(foot)) / part;
    Vec3d half;
    for (int a = 0; a < 3; ++a)
      half[a] = radius * std::sqrt(std::max(0.0, 1 - normal[a] * normal[a]));
    entry.bounds = {foot - half, foot + half};
  }
}

/// A tree for each shape, those of the previous set where their boxes are wide enough.
void SurfaceSet::Data::grow_trees(double reach, const Data* previous) {
  if (planes.size() == surfaces.size())
    return;
  device = previous && previous->device ? previous->device : make_device();
  // Embree rounds rays to single precision in each shape's own space; boxes are wider by as much,
  // but never by so much that they hold nothing out.
  constexpr double rounding = 1e-6, widest = 0.01;
  std::map<const Shape*, double> margins;
  for (const Placed& entry : surfaces) {
    const Shape* shape = entry.surface.shape.get();
    if (shape->is_infinite())
      continue;
    const double size = length(shape->bounds().size());
    const double local_reach = reach / least_stretch(entry.place.to_shape) + size;
    margins[shape] = std::max(margins[shape], std::min(rounding * local_reach, widest * size));
  }
  for (const Placed& entry : surfaces) {
    const std::shared_ptr<const Shape>& shape = entry.surface.shape;
    if (shape->is_infinite())
      continue;
    std::shared_ptr<const ShapeTree>& tree = trees[shape.get()];
    if (tree)
      continue;
    const double margin = margins[shape.get()];
    if (previous)
      if (const auto known = previous->trees.find(shape.get()); known != previous->trees.end())
        tree = known->second;
    // Room for a shape that moves on: twice as much is as good.
    if (!tree || tree->margin() < margin || tree->margin() > 8 * margin) {
      tree = std::make_shared<const ShapeTree>(device, shape, 2 * margin);
      ++trees_built;
    }
  }
}

void SurfaceSet::Data::build_scene() {
  if (!device)
    return;
  scene.reset(rtcNewScene(device.get()));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].surface.shape->is_infinite())
      continue;
    RTCGeometry instance = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    const Affine& map = surfaces[i].surface.to_render;
    float matrix[12];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        matrix[4 * row + column] = static_cast<float>(map.rows[row][column]);
      matrix[4 * row + 3] = static_cast<float>(map.translation[row]);
    }
    rtcSetGeometryInstancedScene(instance, trees.at(surfaces[i].surface.shape.get())->scene());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, matrix);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(scene.get(), instance, static_cast<unsigned>(i));
    rtcReleaseGeometry(instance);
  }
  commit(scene.get(), device);
}

/// False where nothing more is asked for.
bool SurfaceSet::Data::meet_planes(Query& query) const {
  // Single precision holds the squares of positions.
  constexpr double farthest = 1e17;
  const double end = query.t_end;
  for (const unsigned i : planes) {
    const Placed& entry = surfaces[i];
    if (query.camera && !entry.surface.visible)
      continue;
    const auto hit = query.meet(i, 0, std::min(query.t_end, farthest));
    if (!hit)
      continue;
    query.hit = *hit;
    query.found = i;
    query.found_primitive = 0;
    query.t_end = hit->t;
  }
  const bool met = query.found != RTC_INVALID_GEOMETRY_ID;
  if (!met)
    query.t_end = end;
  return device && !(met && query.any);
}

void SurfaceSet::Data::run(Query& query) const {
  rtcInitIntersectContext(&query.context);
  query.surfaces = &surfaces;
  if (!meet_planes(query))
    return;
  // A far origin is moved up to the surfaces.
  const double along = dot(center - query.origin, query.direction);
  query.shift = std::max(query.t_begin, along - 1.01 * ball_radius);
  const Vec3d start = query.origin + query.direction * query.shift;
  // From farther away it passes by them. Embree ends the program if a ray is none, or its numbers
  // are too large for single precision.
  if (!(length(start - center) <= 1.5 * ball_radius) ||
      !(dot(query.direction, query.direction) > 0))
    return;
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

/// From the nearest surface but one that is skipped.
double SurfaceSet::Data::distance(const Vec3d& point, double most, unsigned skipped) const {
  for (const unsigned i : planes)
    if (i != skipped)
      most = std::min(most, surfaces[i].surface.shape->distance(0, point, surfaces[i].place));
  if (!device)
    return most;
  Nearest nearest{&surfaces, point, most, skipped};
  // Embree 3.13 begins in a shape's own space with the radius as it is, in units of that space: too
  // small where the shape is. From the first primitive on it converts the radius.
  RTCPointQuery query{static_cast<float>(point.x), static_cast<float>(point.y),
                      static_cast<float>(point.z), 0, radius_of(most * most_shrink)};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene.get(), &query, &context, approach_primitive, &nearest);
  return nearest.distance;
}

SurfaceSet::SurfaceSet(std::vector<PlacedShape> surfaces, double reach, const SurfaceSet* previous)
    : data_(std::make_unique<Data>()) {
  data_->place(std::move(surfaces));
  const Boxd& box = data_->bounds;
  if (!box.empty())
    reach += std::max(length(box.lower), length(box.upper)) + length(box.size());
  data_->bound_planes(reach);
  data_->grow_trees(reach, previous ? previous->data_.get() : nullptr);
  data_->build_scene();
  // Embree's trees over user geometry take about 60 bytes per primitive.
  constexpr std::size_t tree_bytes = 60;
  for (const auto& [shape, tree] : data_->trees)
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
  const Placed& entry = data_->surfaces[query.found];
  SurfaceHit hit;
  hit.t = query.hit.t;
  hit.position = origin + direction * hit.t;
  hit.normal = Vec3f(entry.normal(query.hit.normal));
  hit.shading_normal = hit.normal;
  hit.surface = static_cast<int>(query.found);
  hit.primitive = query.found_primitive;
  if (entry.surface.textured)
    hit.uv = uv(hit);
  if (entry.surface.shape->is_smooth()) {
    const Vec3d local = entry.place.to_shape.point(hit.position);
    hit.shading_normal =
        Vec3f(entry.normal(entry.surface.shape->shading_normal(hit.primitive, local)));
    hit.smooth = true;
  }
  if (entry.surface.detail && entry.surface.detail->has_normals()) {
    hit.shading_normal = entry.detailed_normal(hit);
    hit.smooth = true;
  }
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
  return data_->distance(point, most);
}

bool SurfaceSet::is_flat_and_alone(std::size_t surface, const Vec3d& point, double radius) const {
  const PlacedShape& placed = data_->surfaces[surface].surface;
  return placed.shape->is_flat() && !(placed.detail && placed.detail->has_holes()) &&
         !(data_->distance(point, radius, static_cast<unsigned>(surface)) < radius);
}

bool SurfaceSet::holds(std::size_t surface, const Vec3d& point) const {
  const Placed& entry = data_->surfaces[surface];
  const Vec3d local = entry.place.to_shape.point(point);
  return entry.surface.shape->holds(local.x, local.y);
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
bool SurfaceSet::is_infinite(std::size_t surface) const {
  return data_->surfaces[surface].surface.shape->is_infinite();
}
std::size_t SurfaceSet::bytes() const {
  return data_->bytes;
}
double SurfaceSet::area(std::size_t surface) const {
  // Areas of stretched shapes have no closed form in general: the mean over points of the shape.
  const Placed& entry = data_->surfaces[surface];
  const Shape& shape = *entry.surface.shape;
  constexpr int points = 64;
  constexpr std::size_t few = 8;
  double sum = 0;
  if (const std::size_t count = shape.primitives(); count > 1 && count <= few) {
    for (std::size_t primitive = 0; primitive < count; ++primitive) {
      const double part = shape.area_before(primitive + 1) - shape.area_before(primitive);
      for (int i = 0; i < points * points; ++i) {
        const AreaPlace place{(i % points + 0.5) / points, (i / points + 0.5) / points};
        sum += part * entry.stretch(shape.sample(primitive, place).normal);
      }
    }
    return sum / (points * points);
  }
  for (int i = 0; i < points * points; ++i) {
    const int row = i / points;
    const double u = (i % points + 0.5) / points, v = (row + 0.5) / points;
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

int SurfaceSet::trees_built() const {
  return data_->trees_built;
}

int SurfaceSet::devices_made() {
  return vdbeam::devices_made();
}

} // namespace vdbeam
