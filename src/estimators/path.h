#pragma once

#include "estimators/estimator.h"
#include "math/rng.h"
#include "transport/delta_tracking.h"

namespace vdbeam {

/// Unbiased volumetric path tracing: delta tracking (spectral tracking where the extinction is
/// chromatic, Kutz et al. 2017), next-event estimation at every collision, multiple importance
/// sampling for lights that a scattered ray can meet. The truth that the others are held against.
class PathEstimator : public Estimator {
public:
  explicit PathEstimator(const EstimatorInput& input) : input_(input) {}

  void render_pass(int pass, PassImage& image, RenderStatistics& statistics) override;

private:
  struct Outputs;
  struct State;

  void trace(const struct CameraRay& camera_ray, Rng& rng, Outputs& out) const;
  Rgb escape(const State& state) const;
  Rgb light(const State& state, const PhaseFunction& phase, Rng& rng) const;

  EstimatorInput input_;
};

} // namespace vdbeam
