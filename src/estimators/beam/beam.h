#pragma once

#include "estimators/beam/beam_weights.h"
#include "estimators/estimator.h"
#include "estimators/pilot/beam_plan.h"
#include "photons/photon_pass.h"
#include "rays/tile_rays.h"

namespace vdbeam {

struct TileScratch;

/// The beam radiance estimate (Jarosz, Zwicker, Jensen 2008, eq. 11) for heterogeneous media: per
/// camera ray one query gathers all photons along it,
///   L = sum_i K(d_i, r_i) Tr(0, t_i) sigma_s(t_i) p(w_i, -d) flux_i / majorant_i,
/// to which single scattering of the sampled lights and what is seen through the medium are added.
class BeamEstimator : public Estimator {
public:
  explicit BeamEstimator(const EstimatorInput& input)
      : input_(input), photons_(input, plan_beam_photons, KernelDomain::disc) {}

  void render_pass(int pass, PassImage& image, RenderStatistics& statistics) override;

  const PhotonPass& photons() const { return photons_; }

private:
  void gather_volumes(TileScratch& scratch, WeightSettings weights, PassImage& image);

  EstimatorInput input_;
  PhotonPass photons_;
};

} // namespace vdbeam
