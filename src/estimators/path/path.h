#pragma once

#include "estimators/estimator.h"
#include "estimators/path/path_effort.h"
#include "medium/distance_sampling.h"
#include "rays/profile_shading.h"
#include "transport/camera_ray.h"
#include "walks/walk_tracer.h"

namespace vdbeam {

/// Unbiased volumetric path tracing: the camera ray scatters by its depth profile (forced,
/// stratified, several times), then WalkTracer goes on. The truth that the others are held against.
class PathEstimator : public Estimator {
public:
  /// `least_time`: of each part, as in PathTrial::best_effort; more where rays are few.
  explicit PathEstimator(const EstimatorInput& input, double least_time = 1);

  void render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) override;

  /// Radiance of these pixels of the pass, along the same camera rays as every estimator's.
  std::vector<Rgb> radiance(int pass, const std::vector<std::size_t>& pixels) const;

  /// Pixels of the picture to the pixels of a picture one row high; `finished` marks which ones
  /// were done before the input's `stop` asked to end.
  /// Adds what it counts to `statistics`.
  void render_pixels(int pass, const std::vector<std::size_t>& pixels, PassImage& image,
                     std::vector<std::uint8_t>& finished, RenderStatistics& statistics) const;

private:
  struct Scratch;

  /// A camera ray with its depth profile, what of it reaches its end, and where its light goes.
  struct RayTask;

  RngKey key(int pass) const;
  CameraRay camera_ray_of(const RngKey& key, std::size_t pixel) const;
  void render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch, std::size_t target,
                    PassImage& image) const;
  void begin_walk(const RayTask& ray, const ScatterPoint& point, float share, Rng& rng,
                  const Rng& walk_rng, Scratch& scratch, PassImage& image) const;
  SeenSurface seen_surface(const RayTask& ray, Scratch& scratch) const;
  SeenSurface seen_catcher(const RayTask& ray, Rng& rng) const;
  void scatter_once(const RayTask& ray, Rng& rng, Scratch& scratch, PassImage& image) const;
  void send_walks(const RayTask& ray, Rng& rng, Scratch& scratch, PassImage& image) const;
  void take_turns(Scratch& scratch, std::size_t most, PassImage& image) const;

  /// What a pilot measures.
  PathTrial try_pixels() const;
  struct TrialRay;
  TrialRay try_ray(std::size_t pixel, std::uint64_t first_pass) const;
  void try_draw(RayTask task, std::size_t draw, Scratch& scratch, TrialRay& result) const;
  static PathTrial trial_of(const std::array<TrialRay, 2>& rays, double weight);

  EstimatorInput input_;
  std::vector<bool> shadow_rays_; ///< per light: next-event estimation finds it
  WalkTracer tracer_;
  bool scatters_ = false; ///< light is scattered towards the camera
  PathEffort effort_;
};

} // namespace vdbeam
