#pragma once

#include "vdbeam/vec.h"

#include <optional>
#include <variant>

namespace vdbeam {

/// A point of a surface as it is seen from somewhere, drawn uniformly by solid angle.
struct SolidAnglePoint {
  Vec3d wi; ///< unit, towards it
  double distance = 0;
  Vec3d normal;   ///< unit, of the surface's front there
  double pdf = 0; ///< per solid angle: one over what the whole surface fills
};

/// A sphere whose front is its outside.
struct Ball {
  Vec3d center;
  double radius = 0;

  /// A point on the side that faces `point`; none from inside.
  std::optional<SolidAnglePoint> sample(const Vec3d& point, double u, double v) const;
  /// Its solid angle from `point`; 0 where `sample` gives nothing.
  double solid_angle(const Vec3d& point) const;
};

/// A rectangle, by Urena, Fajardo and King, An area-preserving parametrization for spherical
/// rectangles, 2013.
struct Rectangle {
  Vec3d corner, edge_x, edge_y; ///< the edges are perpendicular
  Vec3d normal;                 ///< unit, to its front

  /// None from its own plane, or from so far away that its solid angle has no digits.
  std::optional<SolidAnglePoint> sample(const Vec3d& point, double u, double v) const;
  double solid_angle(const Vec3d& point) const;
};

using SolidAngleShape = std::variant<std::monostate, Ball, Rectangle>;

} // namespace vdbeam
