#include "estimators/choose_estimator.h"

#include "estimators/beam.h"
#include "estimators/kernel_pilot.h"
#include "estimators/path.h"
#include "estimators/tile_shading.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {

namespace {

/// Passes of `beam` after which the two are compared: its lead shrinks as passes are added, since
/// the bias of kernels falls more slowly than noise.
constexpr int compared_passes = 32;
/// Names random numbers that neither passes nor other pilots draw.
constexpr int first_trial_pass = -200;
constexpr int trial_passes = 2;
/// `path` must be ahead by this factor: forecasts are right to a factor of about two, and a few
/// pixels miss its rarest and brightest paths.
constexpr double safe_lead = 3;

// Processor time [ns] of what a pass consists of, fitted to 39 scenes, in which the ratio of the
// two estimators came out right within 30 % (docs/decisions.md). Only ratios count.
constexpr double time_of_ray = 10000, time_of_shadow_ray = 5000, time_of_query = 8000,
                 time_of_light_collision = 150, time_of_photon = 2000, time_of_walks = 20000,
                 time_of_walk_collision = 80;
/// By which the sum of these overestimates a pass of `beam` against one of `path`.
constexpr double beam_share = 0.56;

/// The weighted mean square of differences of two pictures, halved: the variance of one of them.
double spread(const std::vector<TrialPixel>& pixels, const PassImage& a, const PassImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Rgb d = a.total(i) - b.total(i);
    for (int c = 0; c < 3; ++c)
      sum += static_cast<double>(pixels[i].weight[c] * d[c] * d[c]) / 6;
  }
  return sum / static_cast<double>(pixels.size());
}

/// The spread of all that does not come from photons, in a pass of `beam`; counts its rays.
double spread_beside_photons(const EstimatorInput& input, const PhotonPass& photons,
                             const std::vector<TrialPixel>& pixels, RenderStatistics& counts) {
  const EstimatorInput in = input.in(photons.world());
  const auto width = static_cast<std::size_t>(input.camera.width());
  PassImage images[trial_passes];
  std::vector<RenderStatistics> counts_by_pixel(pixels.size());
  for (int t = 0; t < trial_passes; ++t) {
    const RngKey key{input.settings.seed, input.frame,
                     static_cast<std::uint64_t>(first_trial_pass + t)};
    images[t].resize(static_cast<int>(pixels.size()), 1, !input.world.medium.emitters.empty());
    tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
      TileRays::PixelRay ray =
          TileRays::pixel_ray(in, key, static_cast<int>(pixels[i].pixel % width),
                              static_cast<int>(pixels[i].pixel / width));
      ray.profile.build(in.world.medium, ray.camera.segment,
                        static_cast<float>(input.settings.cutoff));
      shade_ray(in, photons, ray, {}, key, i, images[t], counts_by_pixel[i]);
    });
  }
  for (const RenderStatistics& pixel : counts_by_pixel)
    counts += pixel;
  return spread(pixels, images[0], images[1]);
}

/// The spread of a pass of `path`; counts its rays and collisions.
double spread_of_path(const EstimatorInput& input, const std::vector<TrialPixel>& pixels,
                      RenderStatistics& counts) {
  std::vector<std::size_t> places;
  for (const TrialPixel& pixel : pixels)
    places.push_back(pixel.pixel);
  const PathEstimator path(input);
  PassImage images[trial_passes];
  std::vector<std::uint8_t> finished;
  for (int t = 0; t < trial_passes; ++t)
    path.render_pixels(first_trial_pass + t, places, images[t], finished, counts);
  return spread(pixels, images[0], images[1]);
}

/// By which factor the error of `path` is greater than that of `beam` after the same time.
double lead_of_beam(const EstimatorInput& beam_input, const PhotonPass& photons,
                    const EstimatorInput& path_input) {
  const PhotonPlan& plan = photons.plan();
  const std::vector<TrialPixel>& pixels = plan.trial->pixels;
  const double rays = static_cast<double>(trial_passes * pixels.size());
  RenderStatistics path_counts, beam_counts;
  const double path_spread = spread_of_path(path_input, pixels, path_counts);
  // Both find single scattering by shadow rays, `beam` with no more noise than `path`.
  const double beside =
      std::min(path_spread, spread_beside_photons(beam_input, photons, pixels, beam_counts));
  const double path_time =
      time_of_ray + time_of_walks +
      (time_of_shadow_ray * static_cast<double>(path_counts.shadow_rays) +
       time_of_walk_collision * static_cast<double>(path_counts.walk_collisions)) /
          rays;
  const double paths_per_ray = static_cast<double>(plan.paths) / count_hits(beam_input);
  const double beam_time =
      beam_share * (time_of_ray + time_of_query +
                    time_of_shadow_ray * static_cast<double>(beam_counts.shadow_rays) / rays +
                    paths_per_ray * (time_of_light_collision * plan.collisions_per_path +
                                     time_of_photon * plan.stored_per_path));
  const double beam_error =
      plan.trial->model.error(plan.neighbours, compared_passes) + beside / compared_passes;
  const double path_error = path_spread * path_time / (compared_passes * beam_time);
  return beam_error > 0 ? path_error / beam_error : 1;
}

} // namespace

EstimatorChoice choose_estimator(const EstimatorInput& beam_input,
                                 const EstimatorInput& path_input) {
  auto beam = std::make_unique<BeamEstimator>(beam_input);
  const PhotonPass& photons = beam->photons();
  if (!photons.plan().trial || photons.plan().trial->pixels.empty())
    return {EstimatorType::beam, "without a kernel pilot there is nothing to compare",
            std::move(beam)};
  const double lead = lead_of_beam(beam_input, photons, path_input);
  if (lead < 1 / safe_lead && !beam_input.stopped())
    return {EstimatorType::path,
            fmt::format("in as much time beam would have {:.2g} times its error", 1 / lead),
            nullptr};
  return {EstimatorType::beam,
          fmt::format("in as much time path would have {:.2g} times its error", lead),
          std::move(beam)};
}

} // namespace vdbeam
