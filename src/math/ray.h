#pragma once

#include "vdbeam/vec.h"

#include <limits>

namespace vdbeam {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float pi = 3.14159265358979323846f;

/// A ray in render space; `direction` has unit length, so t is a distance.
struct Ray {
  Vec3f origin;
  Vec3f direction;

  Vec3f at(float t) const { return origin + direction * t; }
};

/// The piece of a ray between two distances; to infinity where the ray leaves the scene.
struct Segment {
  Ray ray;
  float t_begin = 0, t_end = infinity;

  bool empty() const { return !(t_begin < t_end); }
};

} // namespace vdbeam
