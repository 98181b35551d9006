#include "choose/choose_estimator.h"

#include "choose/feature.h"
#include "choose/pilot/kernel_pilot.h"
#include "choose/pilot/trial_tile.h"
#include "estimators/estimator_table.h"
#include "estimators/path/path.h"
#include "math/pass_numbers.h"
#include "shading/tile_shading.h"
#include "transport/similar_medium.h"
#include "tuning/constants.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>

namespace vdbeam {

namespace {

/// Weighted variance of independent images of the same scene, by pixel.
std::vector<double> spread(const std::vector<TrialPixel>& pixels,
                           const std::vector<PassImage>& images) {
  const auto count = static_cast<float>(images.size());
  std::vector<double> result(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Rgb mean;
    for (const PassImage& image : images)
      mean += image.total(i) / count;
    double sum = 0;
    for (const PassImage& image : images) {
      const Rgb d = image.total(i) - mean;
      for (int c = 0; c < 3; ++c)
        sum += static_cast<double>(pixels[i].weight[c] * d[c] * d[c]) / 3;
    }
    result[i] = sum / static_cast<double>(count - 1);
  }
  return result;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The spread of all that does not come from photons, in a pass of `beam`; counts its rays. Edges
/// are seen by one ray here, by four in the picture (tile_shading.cpp), so noise is slightly
/// overestimated and time underestimated.
std::vector<double> spread_beside_photons(const EstimatorInput& input, const PhotonPass& photons,
                                          const std::vector<TrialPixel>& pixels,
                                          RenderStatistics& counts) {
  const EstimatorInput in = input.in(photons.world());
  const int passes = tuning::trial_passes;
  std::vector<PassImage> images(static_cast<std::size_t>(passes));
  std::vector<RenderStatistics> counts_by_pixel(pixels.size());
  for (int t = 0; t < passes; ++t) {
    PassImage& image = images[static_cast<std::size_t>(t)];
    const RngKey key{input.settings.seed, input.frame,
                     static_cast<std::uint64_t>(first_trial_pass + t)};
    image.resize(static_cast<int>(pixels.size()), 1, !input.world.medium.emitters.empty());
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
      if (in.stopped())
        return;
      shade_ray(in, photons, trial_ray(in, key, pixels[i].pixel), key,
                {i, image, counts_by_pixel[i]});
    });
  }
  for (const RenderStatistics& pixel : counts_by_pixel)
    counts += pixel;
  return spread(pixels, images);
}

/// The spread of a pass of `path`; counts its rays and collisions.
std::vector<double> spread_of_path(const EstimatorInput& input,
                                   const std::vector<TrialPixel>& pixels,
                                   RenderStatistics& counts) {
  std::vector<std::size_t> places;
  for (const TrialPixel& pixel : pixels)
    places.push_back(pixel.pixel);
  const PathEstimator path(input);
  std::vector<PassImage> images(tuning::trial_passes);
  std::vector<std::uint8_t> finished;
  for (std::size_t t = 0; t < images.size(); ++t)
    path.render_pixels(first_trial_pass + static_cast<int>(t), places, images[t], finished, counts);
  return spread(pixels, images);
}

/// Error of `path` over that of photons after the same time.
double lead_of_photons(const EstimatorInput& photon_input, const FramePasses& passes,
                       const EstimatorInput& path_input) {
  const Choices& choices = passes.choices();
  const PhotonPlan& plan = choices.photons;
  const std::vector<TrialPixel>& pixels = choices.trial->pixels;
  const double rays = static_cast<double>(pixels.size()) * tuning::trial_passes;
  RenderStatistics path_counts, beam_counts;
  const std::vector<double> of_path = spread_of_path(path_input, pixels, path_counts);
  std::vector<double> beside =
      spread_beside_photons(photon_input, passes.photons(), pixels, beam_counts);
  // Both find single scattering by shadow rays, `beam` with no more noise than `path`. A pixel
  // where it has more shows what is rare, as a ray that passes a lamp.
  for (std::size_t i = 0; i < beside.size(); ++i)
    beside[i] = std::min(beside[i], of_path[i]);
  const double of_shadow_ray = time_of_shadow_ray(photon_input.world.medium);
  const double path_time =
      tuning::time_of_camera_ray + time_of_paths(photon_input.world.medium, path_counts) / rays;
  const double paths_per_ray = static_cast<double>(plan.paths) / plan.hits;
  const double beam_time =
      tuning::time_of_camera_ray +
      tuning::time_of_photon_pass *
          (of_shadow_ray * static_cast<double>(beam_counts.shadow_rays) / rays +
           paths_per_ray * (tuning::time_of_light_collision * plan.collisions_per_path +
                            tuning::time_of_photon * plan.stored_per_path));
  double of_photons = choices.trial->model.error(plan.neighbours, tuning::passes_compared);
  if (choices.gather)
    of_photons = std::min(of_photons, choices.gather->error_after(tuning::passes_compared));
  const double beam_error = of_photons + mean_of(beside) / tuning::passes_compared;
  const double path_error = mean_of(of_path) * path_time / (tuning::passes_compared * beam_time);
  return beam_error > 0 ? path_error / beam_error : 1;
}

/// Tentative collisions of a light path, the mean over a few: what the pilot of `beam`, which
/// traces thousands of paths and stores their collisions, would cost.
double collisions_of_light_paths(const EstimatorInput& input) {
  constexpr std::uint64_t probe_paths = 64;
  if (!input.plan.needs(Stage::photons) || input.world.medium.empty())
    return 0;
  const PhotonPlan plan = default_photon_plan(input);
  PassWorlds worlds(input.world);
  const EstimatorInput in = input.in(planned_world(choose_peak(input, auto_estimator), worlds));
  PhotonPassSettings settings = pass_settings(in, plan, rare_photons_pass);
  settings.paths = probe_paths;
  settings.store_probability = 0;
  return trace_photons(in.world, settings).mean_collisions;
}

} // namespace

std::optional<std::string> why_photons_are_rare(const EstimatorInput& input) {
  // In such a medium the photons that are seen lie in a thin skin, and most paths end by chance.
  const double collisions = collisions_of_light_paths(input);
  if (!(collisions > tuning::most_collisions_per_path) || input.stopped())
    return std::nullopt;
  return fmt::format("a light path has about {:.1g} collisions, too many to trace photons",
                     collisions);
}

EstimatorChoice choose_estimator(const EstimatorInput& photon_input,
                                 const EstimatorInput& path_input) {
  if (auto reason = why_photons_are_rare(photon_input))
    return {EstimatorType::path, std::move(*reason), 0, nullptr};
  auto passes = std::make_unique<FramePasses>(EstimatorType::automatic, photon_input);
  const Choices& choices = passes->choices();
  const EstimatorType type = choices.gather ? EstimatorType::gather : EstimatorType::beam;
  // Most light passes the medium by, as where it hangs over a wide ground. A kernel pilot, which
  // needs thousands of photons, shows what they are worth.
  const bool tried = choices.trial && !choices.trial->pixels.empty();
  const double fewest_per_path =
      tried ? tuning::rarest_photons : tuning::rarest_photons_without_pilot;
  const double stored = choices.photons.stored_per_path;
  if (photon_input.plan.needs(Stage::photons) && photon_input.world.surfaces &&
      stored < fewest_per_path && !photon_input.stopped())
    return {EstimatorType::path,
            stored > 0 ? fmt::format("one photon is stored in {:.0f} light paths", 1 / stored)
                       : "no light path stores a photon",
            0, nullptr};
  if (!tried)
    return {type, "without a kernel pilot there is nothing to compare", 0, std::move(passes)};
  if (!sees_directly(photon_input.world))
    return {type, "path may miss caustics", 0, std::move(passes)};
  const double lead = lead_of_photons(photon_input, *passes, path_input);
  if (lead < 1 / tuning::safe_lead && !photon_input.stopped())
    return {
        EstimatorType::path,
        fmt::format("at equal time {} has {:.2g} times its predicted error", type.name, 1 / lead),
        lead, nullptr};
  return {type, fmt::format("at equal time path has {:.2g} times its predicted error", lead), lead,
          std::move(passes)};
}

// It reads the keys of beam, and is planned as beam; the choice is made before the first pass.
const EstimatorKind auto_estimator{
    .name = "auto",
    .help = "gather, beam or path: the one with the smallest error predicted by a pilot",
    .unbiased = false,
    .stages = gather_stages,
    .keys = {},
    .make = nullptr};

} // namespace vdbeam
