#pragma once

#include "medium/delta_tracking.h"

namespace vdbeam {

/// Tentative collisions after which a ray goes on without majorants. Rays that take so many are
/// rare but where a cell of 8^3 voxels holds both dense and empty ones, and more collisions cost
/// more than the exact integral through the rest of the grid.
constexpr int most_tentative_collisions = 256;

/// The first collision of the medium on the segment, found in the exact optical depth: a Poisson
/// process whose rate is the volumes' extinction in their strongest channels, so that
/// `Collision::majorant` is `Collision::sigma_t`. t is infinity where the segment ends first. Its
/// work is bounded by the voxels on the way, whatever their densities.
Collision exact_collision(const Medium& medium, const Segment& segment, Rng& rng);

/// The tentative collisions of MediumTracker, of which there may be as many as the optical depth of
/// the majorants, millions in a cell that is dense here and empty there. After
/// most_tentative_collisions of them the majorant is the extinction itself: the collisions that
/// follow are real, but for channels in which the extinction is less. Collisions are independent of
/// what lies behind them, so nothing is changed in the mean.
///
/// Not for photons, which are stored with a weight of 1 / majorant: that would have no bound.
/// Requires a medium that is not empty.
class BoundedTracker {
public:
  BoundedTracker(const Medium& medium, const Segment& segment)
      : medium_(medium), segment_(segment), tracker_(medium, segment) {}

  /// The next collision; t is infinity where the segment ends first.
  Collision next(Rng& rng) {
    const Collision hit = ++collisions_ <= most_tentative_collisions
                              ? tracker_.next(rng)
                              : exact_collision(medium_, segment_, rng);
    segment_.t_begin = hit.t;
    return hit;
  }

private:
  const Medium& medium_;
  Segment segment_; ///< what is left of it
  MediumTracker tracker_;
  int collisions_ = 0;
};

} // namespace vdbeam
