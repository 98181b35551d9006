#pragma once

#include "transport/medium.h"

#include <vector>

namespace vdbeam {

/// About how much of a distant light reaches each point: optical depths towards it, exact at the
/// points of a coarse lattice over the medium and interpolated in between. Good enough to choose
/// where shadow rays are sent, not to shade.
class ShadowLattice {
public:
  /// For a light in the direction `towards` (unit); sends about `rays` shadow rays.
  ShadowLattice(const Medium& medium, const Vec3f& towards, double rays);

  /// Transmittance from the point to the light, of the clearest channel.
  float transmittance(const Vec3f& point) const;
  /// Distance of lattice points, along the axis where it is least.
  float step() const { return step_; }

private:
  Vec3<int> counts_; ///< lattice points along each axis, at least 2
  float step_;
  Vec3f origin_, spacing_;
  std::vector<float> depths_;
};

} // namespace vdbeam
