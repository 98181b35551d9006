#pragma once

#include "geometry/surface_set.h"

#include <cmath>

namespace vdbeam {

/// A surface with the maps that queries need.
struct Placed {
  PlacedShape surface;
  ShapePlace place;
  Boxd bounds;

  /// A normal of the shape in render space, unit length.
  Vec3d normal(const Vec3d& n) const { return normalize(covector(n)); }
  /// The same, as long as makes it a covector: times the transposed inverse.
  Vec3d covector(const Vec3d& n) const {
    const auto& rows = place.to_shape.rows;
    return rows[0] * n.x + rows[1] * n.y + rows[2] * n.z;
  }
  /// By how much an area grows where its unit normal, in the shape's space, is `n`.
  double stretch(const Vec3d& n) const {
    return std::abs(surface.to_render.determinant()) * length(covector(normalize(n)));
  }
  /// The normal of the image that a surface has, for its shading normal.
  Vec3f detailed_normal(const SurfaceHit& hit) const {
    const Vec3d local = place.to_shape.point(hit.position);
    // Covectors map back by the transposed map.
    const auto& rows = surface.to_render.rows;
    const Vec3d n(hit.normal), local_normal = rows[0] * n.x + rows[1] * n.y + rows[2] * n.z;
    const UvDirections own = surface.shape->uv_directions(hit.primitive, local, local_normal);
    const UvDirections there{surface.to_render.vector(own.right), surface.to_render.vector(own.up)};
    return surface.detail->normal(hit.uv, there, hit.shading_normal, hit.normal);
  }
  SurfacePoint placed(const ShapePoint& point) const {
    SurfacePoint result;
    result.position = surface.to_render.point(point.position);
    result.normal = Vec3f(normal(point.normal));
    result.pdf = static_cast<float>(1 / (surface.shape->area() * stretch(point.normal)));
    return result;
  }
};

/// The map's shortest stretch of a unit vector, or less.
inline double least_stretch(const Affine& inverse) {
  double square = 0;
  for (const Vec3d& row : inverse.rows)
    square += dot(row, row);
  return 1 / std::sqrt(square);
}

inline Boxd mapped(const Affine& map, const Boxd& box) {
  Boxd result;
  for (int corner = 0; corner < 8; ++corner)
    result.extend(
        map.point({corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                   corner & 4 ? box.upper.z : box.lower.z}));
  return result;
}

} // namespace vdbeam
