#pragma once

#include "medium/flight.h"
#include "transport/surfaces.h"

#include <algorithm>
#include <optional>
#include <span>

namespace vdbeam {

/// A light path under way. Its throughput is flux.
struct LightPath : Flight {
  using Flight::Flight;

  std::size_t light = 0;
  std::uint32_t number = 0; ///< within the pass
  // Among surfaces:
  std::optional<SurfaceHit> end; ///< of the present flight
  bool met_surface = false;
  bool by_mirrors = true;    ///< surfaces that it met were specular
  bool for_surfaces = false; ///< stored at surfaces: of surface_photon_lights
  /// Flux, in the strongest channel, with which such paths go to the medium and its nests straight
  /// from their light, over `flux_unit`; empty: surfaces do not aim it.
  std::span<const float> fair_fluxes;
  float flux_unit = 1;
  SurfaceRoulette surfaces;

  /// The path's flux over that of paths from its light to a target.
  float relative_flux(std::size_t target) const {
    return max_component(throughput) * flux_unit /
           fair_fluxes[std::min(target, fair_fluxes.size() - 1)];
  }
};

/// The part of the medium in which a collision is.
inline std::size_t part_of(const Medium& medium, const Collision& hit) {
  return medium.parts[static_cast<std::size_t>(hit.volume - medium.volumes.data())];
}

/// Rate of tentative collisions in a part: the majorants of overlapping volumes add.
inline float majorant_of_part(const Medium& medium, const Ray& ray, const Collision& hit) {
  float sum = hit.majorant;
  const Vec3f point = ray.at(hit.t);
  const std::size_t part = part_of(medium, hit);
  medium.for_each_at(point, [&](std::size_t v) {
    if (&medium.volumes[v] != hit.volume && medium.parts[v] == part)
      sum += medium.volumes[v].majorant(point);
  });
  return sum;
}

} // namespace vdbeam
