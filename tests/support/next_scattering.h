#pragma once

#include "medium/flight.h"

namespace vdbeam::test {

/// Ends a walk at its first real collision.
struct FirstCollision {
  static constexpr bool bounds_null_collisions = false;
  Collision found;

  void meet(Flight&, const Collision&) const {}
  bool pass(Flight&) const { return true; }
  bool collide(Flight&, const Collision& hit) {
    found = hit;
    return false;
  }
  bool leave(Flight&) const { return false; }
};

/// The next real collision along the ray, found by the loop that photons and camera paths use;
/// volume is null where the ray leaves the medium first.
inline Collision next_scattering(const Medium& medium, const Ray& ray, Rgb& weight, Rng& rng) {
  FirstCollision walker;
  if (medium.empty())
    return {};
  Flight flight(rng, weight);
  flight.start(medium, {ray});
  if (advance_flight(flight, walker))
    while (step_flight(medium, flight, walker))
      continue;
  weight = flight.throughput;
  rng = flight.rng;
  return walker.found;
}

} // namespace vdbeam::test
