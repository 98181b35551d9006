#pragma once

#include "geometry/mesh.h"
#include "vdbeam/surface_settings.h"

#include <memory>
#include <optional>

namespace vdbeam {

/// Where a line meets a primitive of a shape, in the shape's own space.
struct ShapeHit {
  double t = 0;
  Vec3d normal; ///< to the front, of any length but 0
};

/// A point drawn uniformly by area, in the shape's own space.
struct ShapePoint {
  Vec3d position, normal;
};

/// Along which a picture on a surface goes to the right and up at a point, in the shape's own
/// space. Neither has unit length, and they need not be at right angles.
struct UvDirections {
  Vec3d right, up;
};

/// Numbers in [0, 1) by which the points of a primitive are drawn.
struct AreaPlace {
  double u = 0, v = 0;
};

/// How a shape stands in the world.
struct ShapePlace {
  Affine to_render, to_shape;
  double most_shrink = 1; ///< the length of a unit vector in the shape's space at most

  static ShapePlace at(const Affine& to_render);
};

/// A surface in its own space, made of primitives numbered from 0. All arithmetic is in double
/// precision, so that rays find even huge triangles where they are.
class Shape {
public:
  virtual ~Shape() = default;

  virtual std::size_t primitives() const = 0;
  /// It has no end: its bounds are those of a part, and it needs no tree.
  virtual bool is_infinite() const { return false; }
  /// It is one primitive, a part of the plane z = 0: the one that `holds` these points.
  virtual bool is_flat() const { return false; }
  virtual bool holds(double x, double y) const {
    static_cast<void>(x), static_cast<void>(y);
    return false;
  }
  virtual Boxd bounds(std::size_t primitive) const = 0;
  /// The nearest point of the line origin + t direction with t_begin < t < t_end; `direction` need
  /// not have unit length.
  virtual std::optional<ShapeHit> intersect(std::size_t primitive, const Vec3d& origin,
                                            const Vec3d& direction, double t_begin,
                                            double t_end) const = 0;
  /// The distance of a point from a primitive in its place, both in render space, or less: exact
  /// for what is flat, and for spheres, disks and cylinders that are not stretched.
  virtual double distance(std::size_t primitive, const Vec3d& point,
                          const ShapePlace& place) const = 0;
  virtual double area() const = 0;
  /// Area of the primitives before this one.
  virtual double area_before(std::size_t primitive) const { return primitive == 0 ? 0 : area(); }
  virtual ShapePoint sample(std::size_t primitive, const AreaPlace& place) const = 0;
  ShapePoint sample(double u_primitive, double u, double v) const {
    return sample(primitive_at(u_primitive), AreaPlace{u, v});
  }
  /// Where `sample` finds a point of a primitive.
  virtual AreaPlace place_of(std::size_t primitive, const Vec3d& point) const = 0;
  virtual bool has_uvs() const { return true; }
  /// Texture coordinates of a point of a primitive.
  virtual Uv uv(std::size_t primitive, const Vec3d& point) const = 0;
  /// Where the picture goes at a point of a primitive whose normal is `normal`.
  virtual UvDirections uv_directions(std::size_t primitive, const Vec3d& point,
                                     const Vec3d& normal) const;
  /// It is shaded as the curved surface that its primitives stand for.
  virtual bool is_smooth() const { return false; }
  /// Normal of that curved surface at a point of a primitive, towards the front, of any length but
  /// 0.
  virtual Vec3d shading_normal(std::size_t primitive, const Vec3d& point) const {
    static_cast<void>(primitive), static_cast<void>(point);
    return {};
  }
  virtual std::size_t bytes() const { return 0; }
  Boxd bounds() const;

private:
  /// The primitive that lies at this share of the area.
  virtual std::size_t primitive_at(double) const { return 0; }
};

std::shared_ptr<const Shape> make_mesh_shape(Mesh mesh);
/// `kind` is not `file`.
std::shared_ptr<const Shape> make_simple_shape(SurfaceShape kind);

} // namespace vdbeam
