#pragma once

#include "estimators/estimator.h"
#include "estimators/path/path_walk.h"
#include "medium/distance_sampling.h"
#include "rays/profile_shading.h"
#include "transport/camera_ray.h"

namespace vdbeam {

/// Unbiased volumetric path tracing: the camera ray scatters by its depth profile (forced,
/// stratified, several times), then WalkTracer goes on. The truth that the others are held against.
class PathEstimator : public Estimator {
public:
  explicit PathEstimator(const EstimatorInput& input);

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

  RngKey key(int pass) const;
  void render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch, std::size_t target,
                    PassImage& image) const;
  void trace(const CameraRay& camera, const RngKey& key, std::size_t pixel, Scratch& scratch,
             std::size_t target, PassImage& image) const;
  void begin_walk(const CameraRay& camera, const ScatterPoint& point, std::size_t target, Rng& rng,
                  const Rng& walk_rng, Scratch& scratch, PassImage& image) const;
  SeenSurface seen_surface(const CameraRay& camera, const RngKey& key, std::size_t pixel) const;
  static void add_deep_light(const PathWalk& walk, float share, PassImage& image);
  void take_turns(Scratch& scratch, std::size_t most, PassImage& image) const;

  EstimatorInput input_;
  std::vector<bool> shadow_rays_; ///< per light: next-event estimation finds it
  WalkTracer tracer_;
  bool scatters_ = false;                   ///< light is scattered towards the camera
  int direct_samples_ = 1;                  ///< shadow-ray samples per camera ray
  int walks_per_ray_ = 1;                   ///< walks per camera ray
  std::uint64_t uncounted_pilot_paths_ = 0; ///< go to the first pass's statistics
};

} // namespace vdbeam
