#pragma once

#include "math/ray.h"
#include "vdbeam/scene.h"
#include "volume/render_space.h"

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
  const Vec3d& origin() const { return origin_; }
  const Vec3d& forward() const { return forward_; }
  const Vec3d& right() const { return right_; }
  const Vec3d& up() const { return up_; }
  double tan_half() const { return tan_half_; }
  int width() const { return width_; }
  int height() const { return height_; }

private:
  Vec3d origin_, forward_, right_, up_;
  double tan_half_;
  int width_, height_;
};

} // namespace vdbeam
