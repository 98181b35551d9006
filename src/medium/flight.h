#pragma once

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
  LengthRoulette length;
  std::optional<MediumTracker> tracker; ///< none where there is no medium

  /// Begins a flight along `along`, before its first collision.
  void start(const Medium& medium, const Segment& along) {
    segment = along;
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

/// The loop over a flight's collisions, one of them per call, by delta tracking (spectral tracking
/// where the extinction is chromatic). False where the walk has ended. A call ends with a prefetch
/// of the density: callers interleave several walks to hide the memory latency.
///
/// The walker, which decides what the walk does, is called at
/// - `meet(walk, collision)`: a tentative collision, not yet known to be null or real;
/// - `pass(walk)`: it was null; returns false where the walk ends nevertheless;
/// - `collide(walk, collision)`: it was real; returns whether the walk goes on (if it does, at
///   the first tentative collision of its next flight);
/// - `leave(walk)`: the flight has reached the end of its segment; returns whether the walk has
///   started another one there.
template <class Walk, class Walker>
bool step_flight(const Medium& medium, Walk& walk, Walker& walker) {
  const Collision hit = walk.tracker->collision();
  walker.meet(walk, hit);
  if (sample_real_collision(hit, medium.chromatic, walk.throughput, walk.rng))
    return walker.collide(walk, hit);
  return walker.pass(walk) && advance_flight(walk, walker);
}

} // namespace vdbeam
