#include "estimators/path.h"

#include "estimators/camera_ray.h"
#include "estimators/direct_light.h"
#include "estimators/pixel_tiles.h"
#include "estimators/profile_shading.h"
#include "transport/distance_sampling.h"
#include "transport/photon_tracing.h"
#include "transport/scattering.h"

#include <tbb/enumerable_thread_specific.h>

#include <chrono>

namespace vdbeam {

namespace {

/// Weight under which Russian roulette begins.
constexpr float roulette_below = 0.1f;

/// Walks per camera ray: where walks are short, the depth profile that they start from costs more
/// than they do, so several share it. From the mean length of a few light paths (not followed far:
/// of long ones it matters only that they are long), never from a clock.
int choose_splits(const EstimatorInput& input) {
  PhotonPassSettings pilot;
  pilot.paths = 256;
  pilot.skip_first_flight.assign(input.world.lights.size(), true);
  pilot.max_bounces = std::min(input.world.settings.max_bounces.value_or(16), 16);
  pilot.key = {input.world.settings.seed, input.frame, ~std::uint64_t(0)};
  const double collisions = trace_photons(input.world, pilot).mean_collisions;
  return std::clamp(static_cast<int>(std::lround(24 / (1 + collisions))), 4, 16);
}

} // namespace

PathEstimator::PathEstimator(const EstimatorInput& input) : input_(input) {
  for (std::size_t i = 0; i < input_.world.lights.size(); ++i)
    shadow_rays_.push_back(input_.world.lights[i].wants_shadow_rays());
  for (const Volume& volume : input_.world.medium.volumes)
    scatters_ = scatters_ || (max_component(volume.albedo) > 0 && input_.world.lights.size() > 0);
  const int samples = input_.world.settings.direct_samples;
  direct_samples_ = samples > 0 ? samples : 4;
  splits_ = choose_splits(input);
}

struct PathEstimator::Outputs {
  Rgb direct, indirect;
};

/// What a thread keeps from pixel to pixel.
struct PathEstimator::Scratch {
  DepthProfile profile;
  RenderStatistics counts;
};

struct PathEstimator::State {
  Ray ray;
  Rgb throughput{1, 1, 1};
  int bounces = 0;
  float phase_pdf = 0; ///< of ray.direction
  Vec3f scatter_point;
};

/// Light that a ray meets where it leaves the scene, weighted against next-event estimation
/// (balance heuristic, Veach and Guibas 1995).
Rgb PathEstimator::escape(const State& state) const {
  Rgb sum;
  for (std::size_t i = 0; i < input_.world.lights.size(); ++i) {
    const Light& light = input_.world.lights[i];
    if (light.is_delta())
      continue;
    // Single scattering of these is complete already (direct_light draws both strategies).
    if (state.bounces == 1 && light.wants_shadow_rays())
      continue;
    float weight = 1;
    if (light.wants_shadow_rays())
      weight = state.phase_pdf /
               (state.phase_pdf + light.incident_pdf(state.scatter_point, state.ray.direction));
    sum += light.escaped_radiance(state.ray.direction) * weight;
  }
  return sum * state.throughput;
}

/// Next-event estimation at state.scatter_point, from all lights that want it.
Rgb PathEstimator::light(const State& state, const PhaseFunction& phase, Rng& rng) const {
  Rgb sum;
  for (std::size_t i = 0; i < input_.world.lights.size(); ++i) {
    const Light& light = input_.world.lights[i];
    if (!light.wants_shadow_rays())
      continue;
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample sample = light.sample_incident(state.scatter_point, u, v);
    if (max_component(sample.value) <= 0)
      continue;
    const float p = phase.evaluate(dot(state.ray.direction, sample.wi));
    const float weight = sample.pdf > 0 ? sample.pdf / (sample.pdf + p) : 1;
    const Ray shadow{state.scatter_point, sample.wi};
    sum += sample.value * (p * weight) *
           ratio_transmittance(input_.world.medium, shadow, sample.distance, rng);
  }
  return sum * state.throughput;
}

/// Scatters at a point that was drawn from the camera ray's profile. Its light by shadow rays is
/// estimated apart (direct_light), so the walk begins with what comes after.
void PathEstimator::scatter_first(const CameraRay& camera, const ScatterPoint& point, Rng& rng,
                                  Outputs& out) const {
  const Medium& medium = input_.world.medium;
  // Which volume scatters, in proportion to its share.
  float total = 0;
  for (const Rgb& weight : *point.weights)
    total += mean_component(weight);
  if (!(total > 0))
    return;
  std::size_t volume = 0;
  float left = rng.uniform() * total - mean_component((*point.weights)[0]);
  while (left >= 0 && volume + 1 < medium.volumes.size())
    left -= mean_component((*point.weights)[++volume]);
  const Rgb& weight = (*point.weights)[volume];
  if (!(mean_component(weight) > 0))
    return;
  State state;
  state.ray = {point.position, camera.ray.direction};
  state.throughput = weight * (total / mean_component(weight));
  turn(state, medium.phases[medium.volumes[volume].group], rng);
  walk(state, rng, out);
}

void PathEstimator::turn(State& state, const PhaseFunction& phase, Rng& rng) const {
  const float u_lobe = rng.uniform(), u = rng.uniform(), v = rng.uniform();
  const Vec3f direction = phase.sample(state.ray.direction, u_lobe, u, v);
  state.phase_pdf = phase.evaluate(dot(state.ray.direction, direction));
  state.scatter_point = state.ray.origin;
  state.ray.direction = direction;
  ++state.bounces;
}

/// The walk after the first scattering, until it leaves or ends.
void PathEstimator::walk(State& state, Rng& rng, Outputs& out) const {
  const World& world = input_.world;
  LengthRoulette length;
  while (!input_.stopped()) {
    const Collision hit = next_scattering(world.medium, state.ray, state.throughput, rng);
    if (hit.volume == nullptr) {
      (state.bounces == 1 ? out.direct : out.indirect) += escape(state);
      return;
    }
    if (world.settings.max_bounces && state.bounces >= *world.settings.max_bounces)
      return;
    state.throughput *= hit.volume->albedo;
    if (!survive_roulette(roulette_below, state.throughput, rng) ||
        !length.survive(state.throughput, rng))
      return;
    const PhaseFunction& phase = world.medium.phases[hit.volume->group];
    state.ray.origin = state.scatter_point = state.ray.at(hit.t);
    out.indirect += light(state, phase, rng);
    turn(state, phase, rng);
  }
}

/// One pixel: what is seen through the medium and single scattering from the depth profile, the
/// rest by walks from points drawn from it.
void PathEstimator::trace(const CameraRay& camera, Scratch& scratch, Rng rng, std::size_t target,
                          PassImage& image) const {
  const World& world = input_.world;
  DepthProfile& profile = scratch.profile;
  profile.build(world.medium, camera.ray, camera.t_begin, camera.t_end,
                static_cast<float>(world.settings.cutoff));
  shade_profile(world, camera, profile, target, image);
  scratch.counts.depth_profiles += profile.empty() ? 0 : 1;
  if (profile.empty() || !scatters_ ||
      (world.settings.max_bounces && *world.settings.max_bounces < 1))
    return;
  Outputs out;
  out.direct = direct_light(world, camera.ray, profile, shadow_rays_, direct_samples_, rng,
                            scratch.counts.shadow_rays);
  DistanceSampler distances(world.medium, camera.ray, profile);
  const float share = 1 / static_cast<float>(splits_);
  Outputs walks;
  for (int i = 0; i < splits_; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) * share;
    const int c = world.medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    if (distances.opacity(c) > 0)
      scatter_first(camera, distances.sample(u, c), rng, walks);
  }
  image.direct[target] = out.direct + walks.direct * share;
  image.indirect[target] = walks.indirect * share;
  scratch.counts.camera_walks += static_cast<std::uint64_t>(splits_);
}

RngKey PathEstimator::key(int pass) const {
  return {input_.world.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
}

/// Pixel `pixel` of the picture, to pixel `target` of `image`.
void PathEstimator::render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch,
                                 std::size_t target, PassImage& image) const {
  const Camera& camera = input_.camera;
  const std::size_t width = static_cast<std::size_t>(camera.width());
  Rng jitter(key, RngStage::camera, pixel);
  const double x = static_cast<double>(pixel % width) + static_cast<double>(jitter.uniform());
  const double y = static_cast<double>(pixel / width) + static_cast<double>(jitter.uniform());
  trace(camera_ray(input_.world, camera, x, y), scratch, Rng(key, RngStage::path, pixel), target,
        image);
}

std::vector<Rgb> PathEstimator::radiance(int pass, const std::vector<std::size_t>& pixels) const {
  const RngKey pass_key = key(pass);
  PassImage image;
  image.resize(static_cast<int>(pixels.size()), 1);
  tbb::enumerable_thread_specific<Scratch> scratches;
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    if (!input_.stopped())
      render_pixel(pass_key, pixels[i], scratches.local(), i, image);
  });
  std::vector<Rgb> result;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    result.push_back(image.direct[i] + image.indirect[i] + image.background[i]);
  return result;
}

void PathEstimator::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  const auto start = std::chrono::steady_clock::now();
  const Camera& camera = input_.camera;
  const RngKey pass_key = key(pass);
  image.resize(camera.width(), camera.height());
  tbb::enumerable_thread_specific<Scratch> scratches;
  for_each_tile(input_, [&](int x0, int y0, int x1, int y1) {
    Scratch& scratch = scratches.local();
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * camera.width() + x;
        render_pixel(pass_key, pixel, scratch, pixel, image);
      }
  });
  for (const Scratch& scratch : scratches) {
    statistics.depth_profiles += scratch.counts.depth_profiles;
    statistics.shadow_rays += scratch.counts.shadow_rays;
    statistics.camera_walks += scratch.counts.camera_walks;
  }
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
  statistics.path +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace vdbeam
