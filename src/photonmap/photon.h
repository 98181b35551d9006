#pragma once

#include "math/unfilled_array.h"
#include "vdbeam/vec.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// Photons as tracing leaves them, structure of arrays.
/// With fluence storage `power` is flux / majorant at the collision [W m], so that sum_i K * power
/// is the fluence along the ray, which supplies sigma_s; with scatter storage it is flux [W].
/// Majorant and sigma_s are those of the photon's part of the medium (Medium::parts).
struct PhotonList {
  UnfilledArray<Vec3f> position; ///< render space
  UnfilledArray<Vec3f>
      direction;            ///< unit direction of travel; empty where no phase function needs it
  UnfilledArray<Rgb> power; ///< per photon, already divided by the number of emitted photons

  /// 1 for photons that the medium has not scattered yet: straight from a light, or by way of
  /// surfaces. Empty where there are none.
  UnfilledArray<std::uint8_t> first_flight;

  /// Group of the light that sent it, < `groups`; empty where lights have no groups.
  UnfilledArray<std::uint16_t> group;
  int groups = 0;

  /// Part of the medium in which the path collided; empty where there is one only.
  UnfilledArray<std::uint8_t> part;

  /// Number of the light path within its pass; empty unless it was asked for. Photons of one path
  /// stand in the order in which it left them.
  UnfilledArray<std::uint32_t> path;

  std::size_t size() const { return position.size(); }
  static constexpr std::size_t bytes_per_photon(bool directions, bool groups) {
    return (directions ? 2 : 1) * sizeof(Vec3f) + sizeof(Rgb) + 2 * sizeof(std::uint8_t) +
           (groups ? sizeof(std::uint16_t) : 0);
  }
};

/// Concatenates the lists; `groups`: number of light groups.
PhotonList join(const std::vector<const PhotonList*>& lists, int groups);

} // namespace vdbeam
