#include "choose/pilot/choose_gather.h"

#include "choose/feature.h"
#include "choose/pilot/trial_tile.h"
#include "choose/schedule.h"
#include "estimators/gather/final_gather.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {

namespace {

/// Variance of the final gather of a camera ray, weighted as in MRSE: means over the pixels.
struct GatherNoise {
  double walks = 0; ///< of the walks of a ray, among the same photons
  double maps = 0;  ///< of the mean of two such values, among all maps
};

/// Each pixel's ray looks at each map twice.
GatherNoise measure_noise(const EstimatorInput& input, const Choices& choices,
                          const KernelTrial& trial) {
  const std::vector<TrialPixel>& pixels = choices.trial->pixels;
  const RngKey key{input.settings.seed, input.frame, pilot_pass};
  const SurfaceLighting surfaces(input, input.world, nullptr);
  std::vector<GatherNoise> noise(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const std::size_t pixel = pixels[i].pixel;
    const TileRays::PixelRay ray = trial_ray(input, key, pixel);
    if (ray.profile.empty() || input.stopped())
      return;
    Rng rng(key, RngStage::final_gather, pixel);
    RenderStatistics uncounted;
    std::vector<Rgb> means;
    Rgb mean, walks;
    for (const PhotonMap& map : trial.maps) {
      const FinalGather gather(input.world, choices.photons, {map}, surfaces);
      const auto light = [&] {
        const GatheredLight found = gather.gather(ray.camera.ray(), ray.profile,
                                                  tuning::walks_of_narrow_fit, 1, rng, uncounted);
        return found.direct.sum() + found.indirect.sum();
      };
      const Rgb a = light(), b = light(), d = a - b;
      means.push_back((a + b) * 0.5f);
      mean += means.back() / static_cast<float>(trial.maps.size());
      walks += d * d * (0.5f / static_cast<float>(trial.maps.size()));
    }
    Rgb maps;
    for (const Rgb& one : means)
      maps += (one - mean) * (one - mean) / static_cast<float>(means.size() - 1);
    noise[i] = {static_cast<double>(mean_component(walks * pixels[i].weight)),
                static_cast<double>(mean_component(maps * pixels[i].weight))};
  });
  GatherNoise sum; // in the order of the pixels, for any number of threads
  for (const GatherNoise& pixel : noise) {
    sum.walks += pixel.walks / static_cast<double>(pixels.size());
    sum.maps += pixel.maps / static_cast<double>(pixels.size());
  }
  return sum;
}

/// Share of lamps in the medium in the power of all lights. The few walks that come near them are
/// far brighter than all others, and the forecast may lack them.
double share_of_lamps_inside(const World& world) {
  const Boxf& box = world.medium.bounds;
  double inside = 0, all = 0;
  for (std::size_t i = 0; i < world.lights.size(); ++i) {
    const double power{max_component(world.lights[i].power())};
    all += power;
    const Vec3d* const lamp = world.lights[i].position();
    if (lamp && min(max(*lamp, Vec3d(box.lower)), Vec3d(box.upper)) == *lamp)
      inside += power;
  }
  return all > 0 ? inside / all : 0;
}

} // namespace

GatherChoice choose_gather(const EstimatorInput& input, const EstimatorKind& kind,
                           const Choices& choices, const KernelTrial& trial, double paths_share) {
  const PhotonPlan& plan = choices.photons;
  if (choices.trial->pixels.empty() || trial.maps.size() < 2 ||
      !is_possible(final_gather_feature, {input, kind, plan.sampled_lights}))
    return {};
  const GatherNoise noise = measure_noise(input, choices, trial);
  const double in_trial = std::max(0.0, noise.maps - noise.walks / 2) * paths_share;
  const double of_photons =
      in_trial * trial.neighbours / (tuning::neighbours_of_gather * plan.neighbours);
  const GatherPlan gather{noise.walks, of_photons, choices.trial->regression};
  const double error = gather.error_after(tuning::passes_compared);
  const double without = choices.trial->model.error(plan.neighbours, tuning::passes_compared);
  const double lead = error > 0 ? without / error : 0;
  if (kind.gathers())
    return {gather, lead};
  // The forecast also lacks the kernels' bias for caustics, at which walks look near their
  // beginning.
  const double preference = tuning::preference_for_gather *
                            (1 - share_of_lamps_inside(input.world)) * (1 - plan.caustic_share);
  if (error > 0 && error < preference * without)
    return {gather, lead};
  return {std::nullopt, lead};
}

} // namespace vdbeam
