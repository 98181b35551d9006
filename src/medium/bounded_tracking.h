#pragma once

#include "medium/delta_tracking.h"

namespace vdbeam {

/// Null collisions of a flight, or tentative ones of a shadow ray, after which it goes on without
/// majorants. Only cells of 8^3 voxels that hold both dense and empty ones make a ray take this
/// number, and further collisions would cost more than the exact integral through the rest.
constexpr int most_tentative_collisions = 256;

/// The first collision of the medium on the segment, found in the exact optical depth: a Poisson
/// process whose rate is the volumes' extinction in their strongest channels, so that
/// `Collision::majorant` is `Collision::sigma_t`. t is infinity where the segment ends first. Its
/// work is bounded by the voxels on the way, whatever their densities.
Collision exact_collision(const Medium& medium, const Segment& segment, Rng& rng);

} // namespace vdbeam
