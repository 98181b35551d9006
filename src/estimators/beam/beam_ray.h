#pragma once

#include "estimators/beam/beam_weights.h"
#include "photons/photon_pass.h"

namespace vdbeam {

/// How rays weigh the photons of a pass.
WeightSettings weight_settings(const PhotonPass& photons, PhotonStore store);

/// Calls visit(weights, setting) for each volume of the pass's world, in weights of light that it
/// alone scatters; `setting`: which volume of the scene it is.
template <class Visit>
void for_each_volume_alone(const PhotonPass& photons, WeightSettings weights, const Visit& visit) {
  const std::vector<Volume>& volumes = photons.world().medium.volumes;
  std::vector<std::uint8_t> only(volumes.size());
  weights.only = &only;
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    only[v] = 1;
    visit(weights, volumes[v].setting);
    only[v] = 0;
  }
}

/// Equation 11 for a single ray whose profile is not empty: light that the photons of one of the
/// pass's maps scatter into it.
GroupedLight beam_radiance(const PhotonPass& photons, const PhotonMap& map,
                           const WeightSettings& weights, const CameraRay& ray,
                           const DepthProfile& profile);

} // namespace vdbeam
