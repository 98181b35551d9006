#pragma once

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "math/rng.h"
#include "transport/distance_sampling.h"

namespace vdbeam {

/// Unbiased volumetric path tracing: the camera ray scatters by its depth profile (forced,
/// stratified), later flights by delta tracking (spectral tracking where the extinction is
/// chromatic, Kutz et al. 2017), next-event estimation at every collision, multiple importance
/// sampling for lights that a scattered ray can meet. The truth that the others are held against.
class PathEstimator : public Estimator {
public:
  explicit PathEstimator(const EstimatorInput& input);

  void render_pass(int pass, PassImage& image, RenderStatistics& statistics) override;

  /// What these pixels of the pass show, along the same camera rays as every estimator's.
  std::vector<Rgb> radiance(int pass, const std::vector<std::size_t>& pixels) const;

private:
  struct Outputs;
  struct State;
  struct Scratch;

  RngKey key(int pass) const;
  void render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch, std::size_t target,
                    PassImage& image) const;
  void trace(const CameraRay& camera, Scratch& scratch, Rng rng, std::size_t target,
             PassImage& image) const;
  void scatter_first(const CameraRay& camera, const ScatterPoint& point, Rng& rng,
                     Outputs& out) const;
  void turn(State& state, const PhaseFunction& phase, Rng& rng) const;
  void walk(State& state, Rng& rng, Outputs& out) const;
  Rgb escape(const State& state) const;
  Rgb light(const State& state, const PhaseFunction& phase, Rng& rng) const;

  EstimatorInput input_;
  std::vector<bool> shadow_rays_; ///< per light: next-event estimation finds it
  bool scatters_ = false;         ///< some light may be scattered at all
  int direct_samples_ = 1;        ///< shadow-ray samples per camera ray
  int splits_ = 1;                ///< walks per camera ray
};

} // namespace vdbeam
