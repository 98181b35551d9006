#include "estimators/path/ray_task.h"

#include "math/pass_numbers.h"
#include "tuning/constants.h"

#include <tbb/parallel_for.h>

// The pilot of PathEstimator: a few rays, with independent draws of each part of their light.

namespace vdbeam {

namespace {

constexpr std::size_t rays_per_pixel = 2, draws_per_ray = 2;
constexpr std::size_t fewest_pixels = 64, most_pixels = 1024, pixels_per_trial = 32;
constexpr std::uint32_t most_rounds = 1024;

/// One pixel from each stratum of the whole picture, whatever part of it is rendered.
std::vector<std::size_t> trial_pixels(const EstimatorInput& input) {
  const std::size_t all = static_cast<std::size_t>(input.camera.width()) *
                          static_cast<std::size_t>(input.camera.height());
  const std::size_t count =
      std::min(all, std::clamp(all / pixels_per_trial, fewest_pixels, most_pixels));
  Rng rng({input.settings.seed, input.frame, first_effort_pass}, RngStage::path, 0);
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (static_cast<double>(i) + static_cast<double>(rng.uniform())) /
                         static_cast<double>(count) * static_cast<double>(all);
    pixels.push_back(std::min(static_cast<std::size_t>(place), all - 1));
  }
  return pixels;
}

/// In double precision: light may be as bright as a float holds, and its square is brighter.
double mean_product(const Rgb& a, const Rgb& b) {
  return dot(Vec3d(a), Vec3d(b)) / 3;
}

} // namespace

struct PathEstimator::TrialRay {
  Rgb certain; ///< light that no draw changes
  std::array<std::array<Rgb, draws_per_ray>, path_part_count> draws;
  std::array<float, path_part_count> share{};
  std::array<double, path_part_count> time{}; ///< of a draw [ns]

  Rgb with_draw(std::size_t draw) const {
    Rgb sum = certain;
    for (const auto& part : draws)
      sum += part[draw];
    return sum;
  }
};

/// One draw of each part of a ray, which goes on from where the pilot's other draws of it went.
void PathEstimator::try_draw(RayTask task, std::size_t draw, Scratch& scratch,
                             TrialRay& result) const {
  constexpr std::size_t target = 0;
  const auto time = [&] { return time_of_paths(input_.world.medium, scratch.counts); };
  const auto part = [&](PathPart which, double least_time, const auto& render) {
    const auto i = static_cast<std::size_t>(which);
    result.share[i] = task.share(which);
    if (!(result.share[i] > 0))
      return;
    task.effort.of(which) = 1;
    PassImage image;
    image.resize(1, 1);
    const double before = time();
    render(image);
    result.draws[i][draw] = image.total(target);
    result.time[i] += (time() - before + least_time) / draws_per_ray;
  };
  Rng rng(task.key, RngStage::path, task.pixel);
  part(PathPart::surface, tuning::time_of_surface_path, [&](PassImage& image) {
    image.background[target] = seen_surface(task, scratch).radiance.sum() * task.transmitted;
  });
  if (!scatters_ || task.profile.empty())
    return;
  part(PathPart::scattered_once, 0,
       [&](PassImage& image) { scatter_once(task, rng, scratch, image); });
  part(PathPart::walks, 0, [&](PassImage& image) {
    send_walks(task, rng, scratch, image);
    take_turns(scratch, 0, image);
  });
}

PathEstimator::TrialRay PathEstimator::try_ray(std::size_t pixel, std::uint64_t first_pass) const {
  Scratch scratch;
  scratch.most_rounds = most_rounds;
  RngKey key{input_.settings.seed, input_.frame, first_pass};
  const CameraRay camera = camera_ray_of(key, pixel);
  scratch.profile.build(input_.world.medium, camera.segment,
                        static_cast<float>(input_.settings.cutoff), camera.air);
  TrialRay result;
  PassImage image;
  image.resize(1, 1, !input_.world.medium.emitters.empty());
  shade_profile(input_, camera, scratch.profile, 0, image, {});
  shade_emission(input_, input_.world, camera, scratch.profile, 0, image,
                 scratch.counts.emission_rays);
  // Also of lights that the camera does not see: hiding a sky must change no other pixel.
  const Rgb left = transmittance(input_.world.medium, scratch.profile);
  image.background[0] =
      lights_through(input_.world, camera.whole(), scratch.profile, left, false).sum();
  result.certain = image.total(0);
  for (std::size_t draw = 0; draw < draws_per_ray; ++draw) {
    --key.pass;
    try_draw(RayTask(input_.world, camera, scratch.profile, key, pixel, 0, {}), draw, scratch,
             result);
  }
  return result;
}

/// What a pixel's rays show, its squared error weighted by `weight`.
PathTrial PathEstimator::trial_of(const std::array<TrialRay, rays_per_pixel>& rays, double weight) {
  PathTrial trial;
  trial.ray_time = tuning::time_of_camera_ray;
  for (const TrialRay& ray : rays)
    for (std::size_t i = 0; i < path_part_count; ++i) {
      const double share{ray.share[i]};
      if (!(share > 0))
        continue;
      const Rgb difference = ray.draws[i][0] - ray.draws[i][1];
      trial.parts[i].variance +=
          weight * mean_product(difference, difference) / 2 / share / rays_per_pixel;
      trial.parts[i].time += ray.time[i] * share / rays_per_pixel;
    }
  // The draws are independent, so that this expects the variance of the rays alone.
  trial.ray_variance = weight *
                       mean_product(rays[0].with_draw(0) - rays[1].with_draw(0),
                                    rays[0].with_draw(1) - rays[1].with_draw(1)) /
                       2;
  return trial;
}

PathTrial PathEstimator::try_pixels() const {
  const std::vector<std::size_t> pixels = trial_pixels(input_);
  std::vector<std::array<TrialRay, rays_per_pixel>> rays(pixels.size());
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    for (std::size_t ray = 0; ray < rays_per_pixel && !input_.stopped(); ++ray)
      rays[i][ray] = try_ray(pixels[i], first_effort_pass - ray * (draws_per_ray + 1));
  });
  std::vector<double> brightness;
  double mean = 0;
  for (const auto& pixel : rays) {
    Rgb sum;
    for (const TrialRay& ray : pixel)
      for (std::size_t draw = 0; draw < draws_per_ray; ++draw)
        sum += ray.with_draw(draw) / float{rays_per_pixel * draws_per_ray};
    brightness.push_back(static_cast<double>(mean_component(sum)));
    mean += brightness.back() / static_cast<double>(pixels.size());
  }
  PathTrial sum;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double known = std::max(0.0, brightness[i]) + tuning::dark_offset * mean;
    if (known > 0)
      sum += trial_of(rays[i], 1 / (known * known));
  }
  return sum;
}

} // namespace vdbeam
