#pragma once

#include "math/ray.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

/// Distances along a piece of a ray in proportion to 1 / r^2, r being the distance to a light at a
/// point: equal angles seen from there (Kulla and Fajardo, Importance Sampling Techniques for Path
/// Tracing in Participating Media, 2012).
class EquiAngular {
public:
  /// The piece from t_begin to t_end, t_begin < t_end.
  EquiAngular(const Ray& ray, const Vec3d& light, float t_begin, float t_end)
      : begin_(t_begin), end_(t_end) {
    const Vec3d to_light = light - Vec3d(ray.origin), direction(ray.direction);
    nearest_ = dot(to_light, direction);
    // A ray through the light itself would have no angles.
    height_ = std::max(length(to_light - direction * nearest_), 1e-6 * (end_ - begin_));
    angle_begin_ = std::atan((begin_ - nearest_) / height_);
    angle_end_ = std::atan((end_ - nearest_) / height_);
  }

  /// True where the light is so near that 1 / r^2 has a peak on the piece: samples pay there.
  bool useful() const {
    constexpr double near = 0.5; // of the piece's length
    return std::hypot(height_, nearest_ - std::clamp(nearest_, begin_, end_)) <
           near * (end_ - begin_);
  }
  /// u in [0, 1].
  float sample(float u) const {
    const double angle = angle_begin_ + static_cast<double>(u) * (angle_end_ - angle_begin_);
    return static_cast<float>(std::clamp(nearest_ + height_ * std::tan(angle), begin_, end_));
  }
  /// Density of `sample` at t; 0 beyond the piece.
  float pdf(float t) const {
    const auto at = static_cast<double>(t);
    if (at < begin_ || at > end_)
      return 0;
    const double x = at - nearest_;
    return static_cast<float>(height_ /
                              ((angle_end_ - angle_begin_) * (height_ * height_ + x * x)));
  }

private:
  double begin_, end_;
  double nearest_ = 0, height_ = 0; ///< where the ray is nearest to the light, and how near
  double angle_begin_ = 0, angle_end_ = 0;
};

} // namespace vdbeam
