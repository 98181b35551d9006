#pragma once

#include "medium/bounded_tracking.h"
#include "medium/scattering.h"

#include <optional>

namespace vdbeam {

/// The state of a random walk through the medium, common to light paths and camera paths. It is at
/// a tentative collision of its flight along `segment`.
struct Flight {
  Flight(const Rng& numbers, const Rgb& weight) : rng(numbers), throughput(weight) {}

  Rng rng;
  Rgb throughput;  ///< or a photon's flux
  Segment segment; ///< of the present flight, from the last scattering on
  int bounces = 0;
  int null_collisions = 0; ///< of the present flight
  LengthRoulette length;
  std::optional<MediumTracker> tracker; ///< none where there is no medium

  /// Begins a flight along `along`, before its first collision.
  void start(const Medium& medium, const Segment& along) {
    segment = along;
    null_collisions = 0;
    if (!medium.empty())
      tracker.emplace(medium, along);
  }
  /// Draws the direction of travel after scattering from the phase function.
  Vec3f sample_direction(const PhaseFunction& phase) {
    const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
    return phase.sample(segment.ray.direction, u_lobe, u, v);
  }
};

/// Advances the walk to the next tentative collision. Where its flight reaches the end of its
/// segment first, `walker.leave(walk)` says whether it goes on. False where it does not.
template <class Walk, class Walker>
bool advance_flight(Walk& walk, Walker& walker) {
  while (!walk.tracker || !walk.tracker->advance(walk.rng))
    if (!walker.leave(walk))
      return false;
  return true;
}

/// Ends a flight that met too many null collisions. From its present collision on, collisions are
/// found in the exact optical depth: the first one is real, unless the extinction differs between
/// channels. Collisions do not depend on the medium behind them, so the mean stays the same.
template <class Walk, class Walker>
bool end_flight(const Medium& medium, Walk& walk, Walker& walker) {
  Collision hit = walk.tracker->collision();
  for (;;) {
    walker.meet(walk, hit);
    if (sample_real_collision(hit, medium.chromatic, walk.throughput, walk.rng))
      return walker.collide(walk, hit);
    if (medium.chromatic && !walk.length.survive(walk.throughput, walk.rng))
      return false;
    hit = exact_collision(medium, {walk.segment.ray, hit.t, walk.segment.t_end}, walk.rng);
    if (!hit.volume)
      return walker.leave(walk) && advance_flight(walk, walker);
  }
}

/// The loop over a flight's collisions, one of them per call, by delta tracking (spectral tracking
/// where the extinction is chromatic, Kutz et al. 2017): the only one of the renderer, for light
/// paths, for paths from the camera and for gathering. False where the walk has ended. A call ends
/// with a prefetch of the density: callers interleave several walks to hide the memory latency.
///
/// The walker, which decides what the walk does, is called at
/// - `meet(walk, collision)`: a tentative collision, not yet known to be null or real;
/// - `pass(walk)`: it was null; returns false where the walk ends nevertheless;
/// - `collide(walk, collision)`: it was real; returns whether the walk goes on (if it does, at
///   the first tentative collision of its next flight);
/// - `leave(walk)`: the flight has reached the end of its segment; returns whether the walk has
///   started another one there.
/// `Walker::bounds_null_collisions`: flights end by end_flight after most_tentative_collisions. Not
/// for photons, which are stored at tentative collisions with a weight of 1 / majorant.
template <class Walk, class Walker>
bool step_flight(const Medium& medium, Walk& walk, Walker& walker) {
  if constexpr (Walker::bounds_null_collisions)
    if (walk.null_collisions >= most_tentative_collisions)
      return end_flight(medium, walk, walker);
  const Collision hit = walk.tracker->collision();
  walker.meet(walk, hit);
  if (sample_real_collision(hit, medium.chromatic, walk.throughput, walk.rng))
    return walker.collide(walk, hit);
  ++walk.null_collisions;
  return walker.pass(walk) && advance_flight(walk, walker);
}

} // namespace vdbeam
