#pragma once

#include "medium/flight.h"
#include "transport/world.h"

#include <optional>

namespace vdbeam {

/// The flights of a random walk through media and among surfaces: of light paths, of paths from the
/// camera, and of gathering.
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
