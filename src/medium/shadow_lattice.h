#pragma once

#include "medium/medium.h"

#include <cmath>
#include <vector>

namespace vdbeam {

/// About how much of a distant light reaches each point: optical depths towards it, exact at the
/// points of a lattice over the medium and interpolated in between. Good enough to choose where
/// shadow rays are sent, not to shade. One axis of the lattice is the light's direction, so that a
/// single ray finds the depths of a whole column of points. Nests of the medium have lattices of
/// their own, in which the points lie as densely as in a medium of the nest alone.
class ShadowLattice {
public:
  /// For a light in the direction `towards` (unit); sends up to about `rays` rays, and the same
  /// number for each nest.
  ShadowLattice(const Medium& medium, const Vec3f& towards, double rays);
  /// Memory of such a lattice over a medium with these bounds [bytes].
  static std::uint64_t bytes(const Boxf& bounds, const Vec3f& towards, double rays);

  /// Optical depth and transmittance from the point to the light, of the clearest channel.
  float depth(const Vec3f& point) const { return finest_at(point).own_depth(point); }
  float transmittance(const Vec3f& point) const { return std::exp(-depth(point)); }
  /// Distance of lattice points, along the axis where it is least, and in the finest lattice.
  float step() const { return finer_.empty() ? step_ : finer_.front().step_; }
  const Vec3<int>& counts() const { return counts_; }
  /// A point of the lattice; index.z counts from the light on.
  Vec3f point(const Vec3<int>& index) const;

private:
  ShadowLattice() = default;
  ShadowLattice(const Medium& medium, const Boxf& bounds, const Vec3f& towards, double rays);
  const ShadowLattice& finest_at(const Vec3f& point) const;
  bool holds(const Vec3f& point) const;
  float own_depth(const Vec3f& point) const;
  void place(const Boxf& bounds, const Vec3f& towards, double rays);
  void trace_column(const Medium& medium, int column);

  Vec3<int> counts_;          ///< lattice points along each axis, at least 2
  float step_ = 0;            ///< the least of `spacing_`
  std::array<Vec3f, 3> axes_; ///< unit; the last is the way the light travels
  Vec3f origin_;              ///< the first point, along the axes
  Vec3f spacing_;
  float to_edge_ = 0; ///< from the first points back to where the light meets the medium's bounds
  std::vector<float> depths_;        ///< x-major
  std::vector<ShadowLattice> finer_; ///< over the nests, the smallest first
};

} // namespace vdbeam
