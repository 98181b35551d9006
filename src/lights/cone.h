#pragma once

#include "math/ray.h"
#include "math/sampling.h"

#include <numbers>

namespace vdbeam {

/// A cone of directions. The half angle is kept as 1 - cos, which stays exact for narrow cones.
struct Cone {
  Vec3d axis{0, 0, 1};
  double one_minus_cos = 2; ///< 2: the whole sphere

  /// Whether a unit vector lies in it.
  bool holds(const Vec3f& direction) const {
    return dot(Vec3d(direction), axis) >= 1 - one_minus_cos;
  }

  double solid_angle() const { return 2 * std::numbers::pi * one_minus_cos; }

  /// Uniform by solid angle.
  Vec3d sample(double u, double v) const {
    const double x = u * one_minus_cos;
    const double sin_theta = std::sqrt(x * (2 - x)), phi = 2 * std::numbers::pi * v;
    Vec3d tangent, bitangent;
    orthonormal_frame(axis, tangent, bitangent);
    return normalize(tangent * (sin_theta * std::cos(phi)) +
                     bitangent * (sin_theta * std::sin(phi)) + axis * (1 - x));
  }
};

/// The part of a segment that lies within a cone of at most 90 degrees about its axis, with its tip
/// at `tip`; of wider cones, or without an end, all of the segment.
Segment part_within(const Cone& cone, const Vec3d& tip, const Segment& segment);

/// 1 - cos of an angle in degrees.
inline double one_minus_cos_degrees(double degrees) {
  const double s = std::sin(degrees * (std::numbers::pi / 360));
  return 2 * s * s;
}

} // namespace vdbeam
