#pragma once

#include "estimators/estimator.h"
#include "photons/photon_pass.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// Conventional volumetric photon mapping (Jensen and Christensen 1998), the method that the beam
/// estimate replaces: ray marching with jittered steps, at each a gather of the photons whose
/// sphere contains the point, with a 3D kernel. Same photons, radii, transmittance and direct light
/// as `beam`; only the gather differs.
class MarchEstimator : public Estimator {
public:
  /// `photons` must outlive this.
  MarchEstimator(const EstimatorInput& input, PhotonPass& photons)
      : input_(input), photons_(photons) {}

  void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) override;

private:
  EstimatorInput input_;
  PhotonPass& photons_;
};

} // namespace vdbeam
