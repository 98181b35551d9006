#pragma once

#include "vdbeam/vec.h"

namespace vdbeam {

/// The opening of a thin lens: a disc, or a regular polygon with the disc's radius at its corners.
class Lens {
public:
  Lens() = default;
  /// `angle` turns the polygon counter-clockwise from a corner on the x axis [degrees].
  Lens(double radius, int blades, double angle) : radius_(radius), blades_(blades), angle_(angle) {}

  bool operator==(const Lens&) const = default;

  double radius() const { return radius_; }
  /// A point uniform over the opening; u, v in [0, 1). z is 0.
  Vec3d sample(double u, double v) const;

private:
  double radius_ = 0;
  int blades_ = 0; ///< less than 3: a disc
  double angle_ = 0;
};

} // namespace vdbeam
