#pragma once

#include "vdbeam/vec.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

inline double distance_to_edge(const Vec3d& p, const Vec3d& a, const Vec3d& edge) {
  const double square = dot(edge, edge);
  const double along = square > 0 ? std::clamp(dot(p - a, edge) / square, 0.0, 1.0) : 0;
  return length(p - a - edge * along);
}

/// From a point to a triangle: to its plane where the point stands above it, else to an edge.
inline double distance_to_triangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  const double square = dot(normal, normal);
  const bool above = square > 0 && dot(cross(b - a, p - a), normal) >= 0 &&
                     dot(cross(c - b, p - b), normal) >= 0 && dot(cross(a - c, p - c), normal) >= 0;
  if (above)
    return std::abs(dot(p - a, normal)) / std::sqrt(square);
  return std::min({distance_to_edge(p, a, b - a), distance_to_edge(p, b, c - b),
                   distance_to_edge(p, c, a - c)});
}

/// The angle from +x towards +y, as a share of the full turn, in [0, 1).
inline double turn(const Vec3d& point) {
  const double share = std::atan2(point.y, point.x) / (2 * 3.14159265358979323846);
  return share < 0 ? share + 1 : share;
}

} // namespace vdbeam
