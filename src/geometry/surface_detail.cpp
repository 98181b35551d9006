#include "geometry/surface_detail.h"

#include <algorithm>
#include <utility>

namespace vdbeam {

SurfaceDetail::SurfaceDetail(const MaterialSettings& material,
                             std::shared_ptr<const Texture> opacity,
                             std::shared_ptr<const Texture> normals)
    : opacity_(static_cast<float>(material.opacity)),
      cutoff_(static_cast<float>(material.opacity_cutoff)),
      slope_(static_cast<float>(material.normal_scale)), opacity_texture_(std::move(opacity)),
      normals_(std::move(normals)) {}

bool SurfaceDetail::stops(const Uv& uv, float chance) const {
  const float opacity = opacity_ * (opacity_texture_ ? opacity_texture_->at(uv).y : 1);
  return cutoff_ > 0 ? opacity >= cutoff_ : chance < opacity;
}

Vec3f SurfaceDetail::normal(const Uv& uv, const UvDirections& directions, const Vec3f& shading,
                            const Vec3f& flat) const {
  const Vec3d n(shading);
  const Vec3d along = directions.right - n * dot(n, directions.right);
  if (!(dot(along, along) > 0))
    return shading;
  const Vec3f right(normalize(along));
  Vec3f up = cross(shading, right);
  if (dot(Vec3d(up), directions.up) < 0) // the picture is mirrored
    up = -up;
  const Rgb code = normals_->at(uv);
  const float x = (2 * code.x - 1) * slope_, y = (2 * code.y - 1) * slope_;
  Vec3f result = normalize(right * x + up * y + shading * std::max(2 * code.z - 1, 0.01f));
  // Seen from below the surface it would be black.
  constexpr float least_cosine = 0.05f;
  if (const float cosine = dot(result, flat); cosine < least_cosine)
    result = normalize(result + flat * (least_cosine - cosine));
  return result;
}

} // namespace vdbeam
