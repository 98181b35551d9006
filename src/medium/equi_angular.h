#pragma once

#include "math/ray.h"
#include "phase/scattering_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {

/// Distances along a piece of a ray in proportion to 1 / r^2, r being the distance to a light at a
/// point: equal angles seen from there (Kulla and Fajardo, Importance Sampling Techniques for Path
/// Tracing in Participating Media, 2012). With a density of the scattering angle, distances are in
/// proportion to that density over r^2. The scattering angle theta is the angle by which light of
/// the lamp turns at the point to travel against the ray.
class EquiAngular {
public:
  /// The piece from t_begin to t_end, t_begin < t_end. `angles`: their density, which must outlive
  /// this; null: all alike.
  EquiAngular(const Ray& ray, const Vec3d& light, float t_begin, float t_end,
              const ScatteringAngles* angles = nullptr)
      : begin_(t_begin), end_(t_end), angles_(angles) {
    const Vec3d to_light = light - Vec3d(ray.origin), direction(ray.direction);
    nearest_ = dot(to_light, direction);
    // A ray through the light itself would have no angles.
    height_ = std::max(length(to_light - direction * nearest_), 1e-6 * (end_ - begin_));
    share_begin_ = share_to(angle_at(begin_));
    share_end_ = share_to(angle_at(end_));
  }

  /// True where the light is so near that 1 / r^2 has a peak on the piece: samples pay there.
  bool useful() const {
    constexpr double near = 0.5; // of the piece's length
    return std::hypot(height_, nearest_ - std::clamp(nearest_, begin_, end_)) <
           near * (end_ - begin_);
  }
  /// u in [0, 1].
  float sample(float u) const {
    const double share = share_begin_ + static_cast<double>(u) * (share_end_ - share_begin_);
    const double angle = angles_ ? angles_->inverse(share) : share * std::numbers::pi;
    // The cotangent is infinite at 0 and pi, which only a rounded share reaches.
    return static_cast<float>(std::clamp(nearest_ - height_ / std::tan(angle), begin_, end_));
  }
  /// Density of `sample` at t; 0 beyond the piece.
  float pdf(float t) const {
    const auto at = static_cast<double>(t);
    if (at < begin_ || at > end_)
      return 0;
    const double x = at - nearest_;
    const double of_angle = angles_ ? angles_->density(angle_at(at)) : 1 / std::numbers::pi;
    return static_cast<float>(of_angle * height_ /
                              ((share_end_ - share_begin_) * (height_ * height_ + x * x)));
  }

private:
  /// theta at t: near 0 far before the lamp, near pi far behind it.
  double angle_at(double t) const { return std::atan2(height_, nearest_ - t); }
  double share_to(double angle) const {
    return angles_ ? angles_->cumulative(angle) : angle / std::numbers::pi;
  }

  double begin_, end_;
  const ScatteringAngles* angles_;
  double nearest_ = 0, height_ = 0; ///< where the ray is nearest to the light, and how near
  double share_begin_ = 0, share_end_ = 0;
};

} // namespace vdbeam
