#pragma once

#include "math/ray.h"

namespace vdbeam {

/// Two unit vectors that complete `n` to a right-handed orthonormal frame (Duff et al. 2017).
template <class T>
void orthonormal_frame(const Vec3<T>& n, Vec3<T>& tangent, Vec3<T>& bitangent) {
  const T sign = std::copysign(T(1), n.z);
  const T a = T(-1) / (sign + n.z);
  const T b = n.x * n.y * a;
  tangent = {T(1) + sign * n.x * n.x * a, sign * b, -sign * n.x};
  bitangent = {b, sign + n.y * n.y * a, -n.y};
}

/// The unit vector at angle acos(cos_theta) from `axis`, turned by `phi` about it.
inline Vec3f direction_about(const Vec3f& axis, float cos_theta, float phi) {
  Vec3f tangent, bitangent;
  orthonormal_frame(axis, tangent, bitangent);
  const float sin_theta = std::sqrt(std::max(0.0f, 1 - cos_theta * cos_theta));
  return normalize(tangent * (sin_theta * std::cos(phi)) + bitangent * (sin_theta * std::sin(phi)) +
                   axis * cos_theta);
}

/// Uniform on the unit sphere; density 1 / (4 pi).
inline Vec3f sample_sphere(float u, float v) {
  const float z = 1 - 2 * u;
  const float r = std::sqrt(std::max(0.0f, 1 - z * z));
  const float phi = 2 * pi * v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

} // namespace vdbeam
