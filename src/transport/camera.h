#pragma once

#include "math/ray.h"
#include "vdbeam/scene.h"
#include "volume/render_space.h"

#include <algorithm>
#include <numbers>

namespace vdbeam {

/// A pinhole camera in render space. Pixel (0, 0) is top left; pixel coordinates are continuous,
/// the centre of the first pixel being (0.5, 0.5).
class Camera {
public:
  Camera(const CameraSettings& settings, const ImageSettings& image, const RenderSpace& space)
      : origin_(space.point(settings.position)), width_(image.width), height_(image.height) {
    forward_ = normalize(settings.look_at - settings.position);
    right_ = normalize(cross(forward_, settings.up));
    up_ = cross(right_, forward_);
    tan_half_ = std::tan(settings.fov * std::numbers::pi / 360);
  }

  /// Unit direction through a pixel position.
  Vec3d direction(double px, double py) const {
    const double sx = (2 * px - width_) / height_ * tan_half_;
    const double sy = (1 - 2 * py / height_) * tan_half_;
    return normalize(forward_ + right_ * sx + up_ * sy);
  }
  /// Unit direction of the ray of the picture that comes nearest to a point.
  Vec3d direction_towards(const Vec3d& point) const {
    const Vec3d p = point - origin_;
    const double x = dot(p, right_), y = dot(p, up_), z = dot(p, forward_);
    const double tan_x = tan_half_ * width_ / height_;
    if (z > 0 && std::abs(x) <= tan_x * z && std::abs(y) <= tan_half_ * z)
      return normalize(p);
    const double depth = std::max(z, 1e-12 * length(p));
    return normalize(forward_ + right_ * std::clamp(x / depth, -tan_x, tan_x) +
                     up_ * std::clamp(y / depth, -tan_half_, tan_half_));
  }
  /// False only where no ray of the picture can meet the box: it lies beyond one of the planes
  /// around the view.
  bool may_see(const Boxd& box) const {
    const double tan_x = tan_half_ * width_ / height_;
    bool behind = true, right = true, left = true, above = true, below = true;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d p = box.corner(corner) - origin_;
      const double x = dot(p, right_), y = dot(p, up_), z = dot(p, forward_);
      behind = behind && z < 0;
      right = right && x > tan_x * z;
      left = left && -x > tan_x * z;
      above = above && y > tan_half_ * z;
      below = below && -y > tan_half_ * z;
    }
    return !(behind || right || left || above || below);
  }
  const Vec3d& origin() const { return origin_; }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  Vec3d origin_, forward_, right_, up_;
  double tan_half_;
  int width_, height_;
};

} // namespace vdbeam
