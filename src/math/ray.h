#pragma once

#include "vdbeam/vec.h"

#include <limits>

namespace vdbeam {

/// A ray in render space; `direction` has unit length, so t is a distance.
struct Ray {
  Vec3f origin;
  Vec3f direction;

  Vec3f at(float t) const { return origin + direction * t; }
};

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float pi = 3.14159265358979323846f;

} // namespace vdbeam
