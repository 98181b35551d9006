#pragma once

#include "geometry/shape.h"
#include "image/texture.h"
#include "math/ray.h"

#include <memory>

namespace vdbeam {

/// What images add to a shape, finer than its triangles: holes, and normals.
class SurfaceDetail {
public:
  /// Either texture may be null.
  SurfaceDetail(const MaterialSettings& material, std::shared_ptr<const Texture> opacity,
                std::shared_ptr<const Texture> normals);

  /// Some rays pass through it.
  bool has_holes() const { return opacity_ < 1 || opacity_texture_; }
  /// Whether the surface stops a ray there. `chance`: uniform in [0, 1), of this ray and this
  /// point: a point of opacity 0.3 stops three rays of ten.
  bool stops(const Uv& uv, float chance) const;

  bool has_normals() const { return normals_ != nullptr; }
  /// The normal of the detail, unit length. `shading` is that of the surface, `flat` its geometric
  /// one, on whose side it stays; both of unit length.
  Vec3f normal(const Uv& uv, const UvDirections& directions, const Vec3f& shading,
               const Vec3f& flat) const;

private:
  float opacity_, cutoff_, slope_;
  std::shared_ptr<const Texture> opacity_texture_, normals_;
};

} // namespace vdbeam
