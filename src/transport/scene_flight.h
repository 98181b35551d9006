#pragma once

#include "medium/flight.h"
#include "transport/world.h"

#include <optional>

namespace vdbeam {

/// A flight of a random walk through media and among surfaces: the state that light paths and walks
/// from the camera share.
struct SceneFlight : Flight {
  using Flight::Flight;

  std::optional<SurfaceHit> end; ///< at which the present flight ends
  SurfaceRoulette surfaces;

  /// Begins a flight, which ends at the first surface.
  void set_out(const World& world, const Vec3d& origin, const Vec3f& direction) {
    start(world.medium, flight_segment(world, origin, direction, end));
  }
};

} // namespace vdbeam
