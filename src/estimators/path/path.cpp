#include "estimators/path/path.h"

#include "estimators/estimator_table.h"
#include "machine/stopwatch.h"
#include "medium/distance_sampling.h"
#include "rays/caught_shadow.h"
#include "rays/direct_light.h"
#include "rays/pixel_tiles.h"
#include "rays/profile_shading.h"
#include "transport/camera_ray.h"
#include "transport/photon_tracing.h"

#include <tbb/enumerable_thread_specific.h>

#include <utility>

namespace vdbeam {

namespace {

constexpr std::size_t walks_under_way = 16;
constexpr std::uint64_t pilot_paths = 256;
/// Collisions of every walk under way between two looks at the clock.
constexpr std::uint32_t rounds_per_check = 128;

/// Walks per camera ray: where walks are short, the depth profile that they start from costs more
/// than they do, so several share it. From the mean length of a few light paths (not followed far:
/// of long ones it matters only that they are long), never from a clock.
int choose_walks_per_ray(const EstimatorInput& input) {
  PhotonPassSettings pilot;
  pilot.paths = pilot_paths;
  pilot.skip_first_flight.assign(input.world.lights.size(), true);
  pilot.max_bounces = std::min(input.settings.max_bounces.value_or(16), 16);
  pilot.key = {input.settings.seed, input.frame, ~std::uint64_t(0)};
  pilot.stop = input.stop;
  const double collisions = trace_photons(input.world, pilot).mean_collisions;
  return std::clamp(static_cast<int>(std::lround(48 / (1 + collisions))), 4, 32);
}

} // namespace

PathEstimator::PathEstimator(const EstimatorInput& input)
    : input_(input), shadow_rays_(input.shadow_ray_lights()),
      tracer_(input.world, shadow_rays_, input.settings.max_bounces),
      scatters_(input.plan.needs(Stage::paths)) {
  if (!scatters_)
    return;
  walks_per_ray_ = choose_walks_per_ray(input);
  uncounted_pilot_paths_ = pilot_paths;
  const int samples = input_.settings.direct_samples;
  direct_samples_ = samples > 0 ? samples : std::max(4, walks_per_ray_ / 4);
}

/// Buffers that a thread keeps from pixel to pixel.
struct PathEstimator::Scratch {
  DepthProfile profile;
  std::vector<PathWalk> walks;
  std::vector<PathWalk> branches; ///< of the present round
  RenderStatistics counts;
};

/// The walk of a path that scatters first at a point that was drawn from the camera ray's profile.
void PathEstimator::begin_walk(const CameraRay& camera, const ScatterPoint& point,
                               std::size_t target, Rng& rng, const Rng& walk_rng, Scratch& scratch,
                               PassImage& image) const {
  const Medium& medium = input_.world.medium;
  const std::optional<VolumeChoice> chosen = choose_volume(point, rng.uniform());
  if (!chosen)
    return;
  const auto& [volume, throughput] = *chosen;
  const Ray ray{point.position, camera.ray().direction};
  const PhaseFunction& phase = medium.phases[medium.volumes[volume].phase_index];
  const DeepRay deep(input_.world, camera, target, image);
  scratch.walks.push_back(tracer_.start(target, walk_rng, ray, throughput, phase));
  scratch.walks.back().piece = deep ? deep.piece(point.t) : 0;
  scratch.walks.back().volume = medium.volumes[volume].setting;
}

/// Radiance of the surface at which a camera ray ends: the mean over a few paths.
SeenSurface PathEstimator::seen_surface(const CameraRay& camera, const RngKey& key,
                                        std::size_t pixel) const {
  if (!camera.hit)
    return {};
  constexpr int paths = 4;
  if (input_.world.surfaces->material(*camera.hit).is_shadow_catcher()) {
    Rng rng(key, RngStage::surface, pixel * paths);
    return {{}, caught_shadow(input_.world, camera, rng)};
  }
  GroupedLight sum;
  for (int i = 0; i < paths; ++i) {
    Rng rng(key, RngStage::surface, pixel * paths + static_cast<std::size_t>(i));
    sum += tracer_.from_surface(*camera.hit, camera.ray().direction, rng);
  }
  return {sum / static_cast<float>(paths)};
}

/// One pixel: what is seen through the medium and single scattering from the depth profile, the
/// rest by walks from points drawn from it, which are left under way.
void PathEstimator::trace(const CameraRay& camera, const RngKey& key, std::size_t pixel,
                          Scratch& scratch, std::size_t target, PassImage& image) const {
  const World& world = input_.world;
  Rng rng(key, RngStage::path, pixel);
  DepthProfile& profile = scratch.profile;
  profile.build(world.medium, camera.segment, static_cast<float>(input_.settings.cutoff));
  shade_profile(input_, camera, profile, target, image, seen_surface(camera, key, pixel));
  shade_emission(input_, world, camera, profile, target, image, scratch.counts.emission_rays);
  scratch.counts.depth_profiles += profile.empty() ? 0 : 1;
  if (profile.empty() || !scatters_)
    return;
  image.add(&PassImage::direct, target,
            direct_light(world, camera.ray(), profile,
                         {shadow_rays_, direct_samples_, nullptr, input_.stop}, rng,
                         scratch.counts.shadow_rays,
                         RaySink(world, camera, input_.layers, target, image)));
  DistanceSampler distances(world.medium, camera.ray(), profile);
  for (int i = 0; i < walks_per_ray_; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) / static_cast<float>(walks_per_ray_);
    const int c = world.medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    const Rng walk_rng(key, RngStage::walk, pixel * static_cast<std::size_t>(walks_per_ray_) + i);
    if (distances.opacity(c) > 0)
      begin_walk(camera, distances.sample(u, c), target, rng, walk_rng, scratch, image);
  }
  scratch.counts.camera_walks += static_cast<std::uint64_t>(walks_per_ray_);
}

RngKey PathEstimator::key(int pass) const {
  return {input_.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
}

/// Pixel `pixel` of the picture, to pixel `target` of `image`.
void PathEstimator::render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch,
                                 std::size_t target, PassImage& image) const {
  const Camera& camera = input_.camera;
  const std::size_t width = static_cast<std::size_t>(camera.width());
  Rng jitter(key, RngStage::camera, pixel);
  const EyeRay eye =
      camera.sample(static_cast<int>(pixel % width), static_cast<int>(pixel / width), jitter);
  trace(camera_ray(input_.world, camera, eye), key, pixel, scratch, target, image);
  take_turns(scratch, walks_under_way, image);
}

/// The light of a walk that has ended, at the depth where it began.
void PathEstimator::add_deep_light(const PathWalk& walk, float share, PassImage& image) {
  if (image.deep_layout->count(walk.target) == 0)
    return;
  float* values = &image.deep[(image.deep_layout->first[walk.target] + walk.piece) *
                              DeepLayout::values_per_piece];
  for (int c = 0; c < 3; ++c)
    values[c] += (walk.direct.sum()[c] + walk.indirect.sum()[c]) * share;
}

/// Lets the walks take turns until no more than `most` are under way. Walks of several pixels:
/// while one waits for its voxels to come from memory, others compute.
void PathEstimator::take_turns(Scratch& scratch, std::size_t most, PassImage& image) const {
  std::vector<PathWalk>& walks = scratch.walks;
  const float share = 1 / static_cast<float>(walks_per_ray_);
  for (std::uint32_t rounds = 0; walks.size() > most; ++rounds) {
    if (rounds % rounds_per_check == rounds_per_check - 1 && input_.stopped())
      return walks.clear();
    scratch.counts.walk_collisions += walks.size();
    for (std::size_t i = 0; i < walks.size();) {
      PathWalk& walk = walks[i];
      if (tracer_.step(walk, scratch.branches)) {
        ++i;
        continue;
      }
      VolumeLights(input_.layers, walk.target, image)
          .add(walk.volume, (walk.direct.sum() + walk.indirect.sum()) * share);
      if (image.deep_layout)
        add_deep_light(walk, share, image);
      image.add(&PassImage::direct, walk.target, walk.direct *= share);
      image.add(&PassImage::indirect, walk.target, walk.indirect *= share);
      if (&walk != &walks.back())
        walk = std::move(walks.back());
      walks.pop_back();
    }
    walks.insert(walks.end(), scratch.branches.begin(), scratch.branches.end());
    scratch.branches.clear();
  }
}

void PathEstimator::render_pixels(int pass, const std::vector<std::size_t>& pixels,
                                  PassImage& image, std::vector<std::uint8_t>& finished,
                                  RenderStatistics& statistics) const {
  const RngKey pass_key = key(pass);
  image.resize(static_cast<int>(pixels.size()), 1, !input_.world.medium.emitters.empty());
  finished.assign(pixels.size(), 0);
  tbb::enumerable_thread_specific<Scratch> scratches;
  // Ranges that do not depend on the threads, so that sums do not either.
  const tbb::blocked_range<std::size_t> all(0, pixels.size(), walks_under_way);
  const auto render = [&](const tbb::blocked_range<std::size_t>& range) {
    Scratch& scratch = scratches.local();
    for (std::size_t i = range.begin(); i < range.end() && !input_.stopped(); ++i)
      render_pixel(pass_key, pixels[i], scratch, i, image);
    take_turns(scratch, 0, image);
    if (!input_.stopped())
      std::fill_n(finished.begin() + static_cast<std::ptrdiff_t>(range.begin()), range.size(), 1);
  };
  tbb::parallel_for(all, render, tbb::simple_partitioner());
  for (const Scratch& scratch : scratches)
    statistics += scratch.counts;
}

std::vector<Rgb> PathEstimator::radiance(int pass, const std::vector<std::size_t>& pixels) const {
  PassImage image;
  std::vector<std::uint8_t> finished;
  RenderStatistics uncounted;
  render_pixels(pass, pixels, image, finished, uncounted);
  std::vector<Rgb> result;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    result.push_back(image.total(i));
  return result;
}

void PathEstimator::render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) {
  const Stopwatch watch;
  input_.begin_step(RenderStep::pass);
  const Camera& camera = input_.camera;
  const RngKey pass_key = key(spec.pass);
  input_.resize(image);
  tbb::enumerable_thread_specific<Scratch> scratches;
  for_each_tile(input_, image, [&](int x0, int y0, int x1, int y1) {
    Scratch& scratch = scratches.local();
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1 && !input_.stopped(); ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * camera.width() + x;
        render_pixel(pass_key, pixel, scratch, pixel, image);
      }
    take_turns(scratch, 0, image);
  });
  statistics.pilot_paths += std::exchange(uncounted_pilot_paths_, 0);
  for (const Scratch& scratch : scratches)
    statistics += scratch.counts;
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
  statistics.path += watch.seconds();
}

const EstimatorKind path_estimator{
    .name = "path",
    .help = "unbiased volumetric path tracing, the reference",
    .unbiased = true,
    .stages = {Stage::surfaces, Stage::depth_profiles, Stage::emission, Stage::shadow_rays,
               Stage::spectral_tracking, Stage::paths},
    .keys = {},
    .make = [](const EstimatorInput& input, PhotonPass*) -> std::unique_ptr<Estimator> {
      return std::make_unique<PathEstimator>(input);
    }};

} // namespace vdbeam
