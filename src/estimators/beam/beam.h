#pragma once

#include "estimators/beam/beam_weights.h"
#include "estimators/estimator.h"

namespace vdbeam {

struct TileScratch;

/// The beam radiance estimate (Jarosz, Zwicker, Jensen 2008) for heterogeneous media: one query
/// gathers all photons along a whole camera ray. Single scattering of the sampled lights and what
/// is seen through the medium are added.
class BeamEstimator : public PhotonEstimator {
public:
  using PhotonEstimator::PhotonEstimator;

  void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) override;

private:
  void gather(TileScratch& scratch, PassImage& image) const;
  void gather_volumes(TileScratch& scratch, PassImage& image) const;
};

} // namespace vdbeam
