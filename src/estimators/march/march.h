#pragma once

#include "estimators/estimator.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// Conventional volumetric photon mapping (Jensen and Christensen 1998), the method that the beam
/// estimate replaces: ray marching with jittered steps, at each a gather of the photons whose
/// sphere contains the point, with a 3D kernel. Same photons, radii, transmittance and direct light
/// as `beam`; only the gather differs.
class MarchEstimator : public PhotonEstimator {
public:
  using PhotonEstimator::PhotonEstimator;

  void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) override;
};

} // namespace vdbeam
