#pragma once

#include "estimators/estimator.h"

namespace vdbeam {

/// Final gathering (Jensen, *Realistic Image Synthesis Using Photon Mapping*, 2001) in a medium:
/// photons are not gathered along the camera ray, but where random walks arrive that begin on it
/// (FinalGather). What the walks of a pixel find is then fitted over the pixels around it
/// (PixelRegression), which see nearly the same light.
class GatherEstimator : public PhotonEstimator {
public:
  using PhotonEstimator::PhotonEstimator;

  void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) override;
};

} // namespace vdbeam
