#pragma once

#include "transport/scene_flight.h"

#include <algorithm>
#include <span>

namespace vdbeam {

/// A light path under way. Its throughput is flux.
struct LightPath : SceneFlight {
  using SceneFlight::SceneFlight;

  std::size_t light = 0;
  std::uint32_t number = 0; ///< within the pass
  // Among surfaces:
  bool met_surface = false;
  bool by_mirrors = true;    ///< surfaces that it met were specular
  bool for_surfaces = false; ///< stored at surfaces: of surface_photon_lights
  /// Flux, in the strongest channel, with which such paths go to the medium and its nests straight
  /// from their light, over `flux_unit`; empty: surfaces do not aim it.
  std::span<const float> fair_fluxes;
  float flux_unit = 1;

  /// The path's flux over that of paths from its light to a target.
  float relative_flux(std::size_t target) const {
    return max_component(throughput) * flux_unit /
           fair_fluxes[std::min(target, fair_fluxes.size() - 1)];
  }
};

/// Rate of tentative collisions in the part of the medium where there is one.
inline float majorant_of_part(const Medium& medium, const Collision& hit, const Vec3f& point) {
  return hit.majorant + medium.majorant(point, medium.part_of(*hit.volume), hit.volume);
}

} // namespace vdbeam
