#pragma once

#include "estimators/beam/beam_weights.h"
#include "photons/photon_pass.h"

namespace vdbeam {

/// How rays weigh the photons of a pass.
WeightSettings weight_settings(const PhotonPass& photons, PhotonStore store);

/// Equation 11 for a single ray whose profile is not empty: light that the photons of one of the
/// pass's maps scatter into it.
GroupedLight beam_radiance(const PhotonPass& photons, const PhotonMap& map,
                           const WeightSettings& weights, const CameraRay& ray,
                           const DepthProfile& profile);

} // namespace vdbeam
