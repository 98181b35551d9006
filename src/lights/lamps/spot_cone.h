#pragma once

#include "lights/lamps/local_light.h"

namespace vdbeam {

/// A spot's cone: how its intensity falls from 1 to 0 at the edge, as a cubic Hermite curve in the
/// cosine.
class SpotCone {
public:
  explicit SpotCone(const LightSettings& settings);

  /// Fraction of the intensity on the axis, in [0, 1].
  double share(const Vec3d& direction) const;
  /// Integral of `share` over all directions [sr].
  double integral() const;
  const Cone& outer() const { return outer_; }

private:
  Cone outer_;
  double inner_; ///< 1 - cos of the angle up to which the light is even
};

/// The narrower of two cones that both hold every useful direction.
inline const Cone& narrower(const Cone& a, const Cone& b) {
  return a.one_minus_cos <= b.one_minus_cos ? a : b;
}

} // namespace vdbeam
