#pragma once

#include "vdbeam/vec.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// Photons as tracing leaves them, structure of arrays.
/// With fluence storage `power` is flux / majorant at the collision [W m], so that sum_i K * power
/// is the fluence along the ray, which supplies sigma_s; with scatter storage it is flux [W].
struct PhotonList {
  std::vector<Vec3f> position; ///< render space
  std::vector<Vec3f>
      direction;          ///< unit direction of travel; empty where no phase function needs it
  std::vector<Rgb> power; ///< per photon, already divided by the number of emitted photons

  /// 1 for photons that the medium has not scattered yet: straight from a light, or by way of
  /// surfaces. Empty where there are none.
  std::vector<std::uint8_t> first_flight;

  /// Number of the light path within its pass; empty unless it was asked for. Photons of one path
  /// stand in the order in which it left them.
  std::vector<std::uint32_t> path;

  std::size_t size() const { return position.size(); }
  static constexpr std::size_t bytes_per_photon(bool directions) {
    return (directions ? 2 : 1) * sizeof(Vec3f) + sizeof(Rgb) + sizeof(std::uint8_t);
  }
  void append(const PhotonList& other) {
    position.insert(position.end(), other.position.begin(), other.position.end());
    direction.insert(direction.end(), other.direction.begin(), other.direction.end());
    power.insert(power.end(), other.power.begin(), other.power.end());
    first_flight.insert(first_flight.end(), other.first_flight.begin(), other.first_flight.end());
    path.insert(path.end(), other.path.begin(), other.path.end());
  }
};

} // namespace vdbeam
