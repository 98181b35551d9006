#pragma once

#include "geometry/shape.h"
#include "geometry/surface_detail.h"
#include "math/ray.h"

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// A shape in its place.
struct PlacedShape {
  std::shared_ptr<const Shape> shape;                    ///< shared by its instances
  Affine to_render;                                      ///< shape's own space -> render space
  bool visible = true;                                   ///< to the camera
  bool textured = false;                                 ///< its hits and points have their UV
  std::shared_ptr<const SurfaceDetail> detail = nullptr; ///< of images; null: none
};

/// Where a ray meets a surface.
struct SurfaceHit {
  double t = 0;   ///< distance along the ray
  Vec3d position; ///< render space
  Vec3f normal;   ///< unit, geometric, towards the front
  /// Unit, of the curved surface that triangles stand for, by which the surface scatters light;
  /// else the geometric one.
  Vec3f shading_normal;
  bool smooth = false; ///< the two differ
  int surface = 0;
  std::size_t primitive = 0; ///< of its shape
  Uv uv;                     ///< of surfaces that show a picture

  /// Where a ray along `direction` begins so that it does not meet this point again: off the
  /// surface by more than rounding may have put the point to the wrong side. In double precision,
  /// in which this is so little that the ray does not slip through the walls of a corner either.
  Vec3d leave(const Vec3f& direction) const {
    const Vec3d& p = position;
    const double largest = max_component(Vec3d{std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double offset = 1e-10 * largest + 1e-15;
    return p + Vec3d(normal) * (dot(direction, normal) < 0 ? -offset : offset);
  }
};

/// A point drawn uniformly by area on a surface.
struct SurfacePoint {
  Vec3d position;
  Vec3f normal;
  float pdf = 0; ///< per area, render units
  Uv uv;         ///< of surfaces that show a picture
};

/// All surfaces of a scene in render space: what rays meet. The only user of Embree, whose trees
/// find the primitives near a ray; whether and where it meets one is decided in double precision,
/// from the ray as it was given, so the answers do not depend on the instruction set. Queries are
/// const and may run concurrently.
class SurfaceSet {
public:
  /// `reach`: how far from the surfaces rays may begin, render units. Shapes that are in the
  /// `previous` set too, wherever they stand there, need no new tree. Throws FrameError where
  /// memory is short.
  SurfaceSet(std::vector<PlacedShape> surfaces, double reach, const SurfaceSet* previous = nullptr);
  ~SurfaceSet();
  SurfaceSet(const SurfaceSet&) = delete;
  SurfaceSet& operator=(const SurfaceSet&) = delete;

  /// The first surface strictly between two distances. `camera`: only what the camera sees.
  std::optional<SurfaceHit> intersect(const Vec3d& origin, const Vec3d& direction, double t_begin,
                                      double t_end, bool camera = false) const;
  std::optional<SurfaceHit> intersect(const Segment& segment) const {
    return intersect(Vec3d(segment.ray.origin), Vec3d(segment.ray.direction),
                     static_cast<double>(segment.t_begin), static_cast<double>(segment.t_end));
  }
  /// Something stands strictly between two distances.
  bool occluded(const Vec3d& origin, const Vec3d& direction, double t_begin, double t_end) const;

  /// The distance of a point from the nearest surface, `most` where that is less. Where a sphere or
  /// disk is stretched it may be less than that.
  double distance(const Vec3d& point, double most) const;

  /// A flat surface lies alone there: nothing else of the scene is nearer to the point than this.
  bool is_flat_and_alone(std::size_t surface, const Vec3d& point, double radius) const;
  /// Whether a flat surface reaches as far as a point of its plane.
  bool holds(std::size_t surface, const Vec3d& point) const;

  std::size_t size() const;
  const Boxd& bounds() const; ///< of all surfaces but planes; empty where there are no others
  /// Bounds of one; of a plane, of the part that sends light to the medium and to other surfaces.
  Boxd bounds(std::size_t surface) const;
  bool is_infinite(std::size_t surface) const;
  std::size_t bytes() const;
  double area(std::size_t surface) const;
  SurfacePoint sample(std::size_t surface, double u_primitive, double u, double v) const;
  std::size_t primitives(std::size_t surface) const;
  /// Share of the surface's primitives before this one in the area of its shape.
  double share_before(std::size_t surface, std::size_t primitive) const;
  /// A point of a primitive; the density is that of points drawn on the whole surface.
  SurfacePoint sample(std::size_t surface, std::size_t primitive, const AreaPlace& place) const;
  /// Texture coordinates of a point of a surface, with or without a texture.
  Uv uv(const SurfaceHit& hit) const;
  /// Where the latter `sample` finds a point.
  AreaPlace place_of(std::size_t surface, std::size_t primitive, const Vec3d& point) const;
  /// The density per area with which `sample` gives a point where the surface has this normal.
  float sample_pdf(std::size_t surface, const Vec3f& normal) const;

  /// Trees that were built for this set: of the shapes that the previous one did not have.
  int trees_built() const;
  /// Embree devices made so far by this process, for tests.
  static int devices_made();

private:
  struct Data;
  std::unique_ptr<Data> data_;
};

} // namespace vdbeam
