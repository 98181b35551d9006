#include "estimators/path/ray_task.h"

#include "estimators/estimator_table.h"
#include "machine/stopwatch.h"
#include "rays/caught_shadow.h"
#include "rays/direct_light.h"
#include "rays/pixel_tiles.h"

#include <tbb/enumerable_thread_specific.h>

#include <utility>

namespace vdbeam {

namespace {

constexpr std::size_t walks_under_way = 16;
/// Collisions of every walk under way between two looks at the clock.
constexpr std::uint32_t rounds_per_check = 128;

} // namespace

PathEstimator::PathEstimator(const EstimatorInput& input, double least_time)
    : input_(input), shadow_rays_(input.shadow_ray_lights()),
      tracer_(input.world, shadow_rays_, input.settings.max_bounces),
      scatters_(input.plan.needs(Stage::paths)) {
  effort_ = try_pixels().best_effort(least_time);
  if (input_.settings.direct_samples > 0)
    effort_.of(PathPart::scattered_once) = static_cast<float>(input_.settings.direct_samples);
}

/// The walk of a path that scatters first at a point that was drawn from the camera ray's profile.
void PathEstimator::begin_walk(const RayTask& ray, const ScatterPoint& point, float share, Rng& rng,
                               const Rng& walk_rng, Scratch& scratch, PassImage& image) const {
  const Medium& medium = input_.world.medium;
  const std::optional<VolumeChoice> chosen = choose_volume(point, rng.uniform());
  if (!chosen)
    return;
  const auto& [volume, throughput] = *chosen;
  const PhaseFunction& phase = medium.phases[medium.volumes[volume].phase_index];
  scratch.walks.push_back(tracer_.start(
      ray.target, walk_rng, {point.position, ray.camera.ray().direction}, throughput, phase));
  PathWalk& walk = scratch.walks.back();
  walk.piece = RaySink(input_.world, ray.camera, nullptr, ray.target, image).piece_at(point.t);
  walk.volume = medium.volumes[volume].setting;
  walk.share = share;
}

/// Radiance of the surface at which a camera ray ends: the mean over paths.
SeenSurface PathEstimator::seen_surface(const RayTask& ray, Scratch& scratch) const {
  if (!ray.camera.hit)
    return {};
  const std::uint64_t stream = ray.pixel * (PathEffort::most + 1);
  Rng rng(ray.key, RngStage::surface, stream);
  if (input_.world.surfaces->material(*ray.camera.hit).is_shadow_catcher())
    return seen_catcher(ray, rng);
  const PartDraws draws = ray.draws_of(PathPart::surface, rng.uniform());
  GroupedLight sum;
  WalkCounts counts;
  for (int i = 1; i <= draws.count; ++i) {
    Rng path_rng(ray.key, RngStage::surface, stream + static_cast<std::uint64_t>(i));
    sum += tracer_.from_surface(*ray.camera.hit, ray.camera.ray().direction, path_rng, true, true,
                                &counts);
  }
  scratch.counts.walk_collisions += counts.steps;
  scratch.counts.walk_shadow_rays += counts.shadow_rays;
  return {sum *= draws.weight};
}

/// A shadow catcher and, where it is asked for, the light on it that the plate does not have.
SeenSurface PathEstimator::seen_catcher(const RayTask& ray, Rng& rng) const {
  SeenSurface seen{.caught = caught_shadow(input_.world, ray.camera, rng)};
  constexpr int paths = 4;
  for (int i = 0; i < paths && input_.layers && input_.layers->tells_added_light(); ++i)
    seen.added +=
        tracer_.added_to_plate(*ray.camera.hit, ray.camera.ray().direction, rng, true).sum() /
        paths;
  return seen;
}

/// Single scattering, from the depth profile.
void PathEstimator::scatter_once(const RayTask& ray, Rng& rng, Scratch& scratch,
                                 PassImage& image) const {
  const World& world = input_.world;
  const PartDraws draws = ray.draws_of(PathPart::scattered_once, rng.uniform());
  if (draws.count == 0)
    return;
  const LightSampling sampling{shadow_rays_, draws.count, nullptr, input_.stop,
                               draws.weight * static_cast<float>(draws.count)};
  const RaySink sink(world, ray.camera, input_.layers, ray.target, image);
  sink.add_sum(&PassImage::direct, direct_light(world, ray.camera.ray(), ray.profile, sampling, rng,
                                                scratch.counts.shadow_rays, sink));
}

/// All other light of the medium, by walks from points that are drawn from the depth profile; they
/// are left under way.
void PathEstimator::send_walks(const RayTask& ray, Rng& rng, Scratch& scratch,
                               PassImage& image) const {
  const Medium& medium = input_.world.medium;
  const PartDraws draws = ray.draws_of(PathPart::walks, rng.uniform());
  if (draws.count == 0)
    return;
  DistanceSampler distances(medium, ray.camera.ray(), ray.profile);
  for (int i = 0; i < draws.count; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) / static_cast<float>(draws.count);
    const int c = medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
    const Rng walk_rng(ray.key, RngStage::walk,
                       ray.pixel * PathEffort::most + static_cast<std::uint64_t>(i));
    if (distances.opacity(c) > 0)
      begin_walk(ray, distances.sample(u, c), draws.weight, rng, walk_rng, scratch, image);
  }
  scratch.counts.camera_walks += static_cast<std::uint64_t>(draws.count);
}

RngKey PathEstimator::key(int pass) const {
  return {input_.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
}

CameraRay PathEstimator::camera_ray_of(const RngKey& key, std::size_t pixel) const {
  const Camera& camera = input_.camera;
  const std::size_t width = static_cast<std::size_t>(camera.width());
  Rng jitter(key, RngStage::camera, pixel);
  const EyeRay eye =
      camera.sample(static_cast<int>(pixel % width), static_cast<int>(pixel / width), jitter);
  return camera_ray(input_.world, camera, eye);
}

/// Pixel `pixel` of the picture, to pixel `target` of `image`: what is seen through the medium,
/// single scattering from the depth profile, and the rest by walks.
void PathEstimator::render_pixel(const RngKey& key, std::size_t pixel, Scratch& scratch,
                                 std::size_t target, PassImage& image) const {
  const World& world = input_.world;
  const CameraRay camera = camera_ray_of(key, pixel);
  DepthProfile& profile = scratch.profile;
  profile.build(world.medium, camera.segment, static_cast<float>(input_.settings.cutoff),
                camera.air);
  const RayTask ray(world, camera, profile, key, pixel, target, effort_);
  shade_profile(input_, camera, profile, target, image, seen_surface(ray, scratch));
  shade_emission(input_, world, camera, profile, target, image, scratch.counts.emission_rays);
  scratch.counts.depth_profiles += profile.empty() ? 0 : 1;
  if (!profile.empty() && scatters_) {
    Rng rng(key, RngStage::path, pixel);
    scatter_once(ray, rng, scratch, image);
    send_walks(ray, rng, scratch, image);
  }
  take_turns(scratch, walks_under_way, image);
}

/// Lets the walks take turns until no more than `most` are under way. Walks of several pixels:
/// while one waits for its voxels to come from memory, others compute.
void PathEstimator::take_turns(Scratch& scratch, std::size_t most, PassImage& image) const {
  std::vector<PathWalk>& walks = scratch.walks;
  for (std::uint32_t rounds = 0; walks.size() > most; ++rounds) {
    if (rounds % rounds_per_check == rounds_per_check - 1 && input_.stopped())
      return walks.clear();
    const bool ends = rounds >= scratch.most_rounds;
    scratch.counts.walk_collisions += walks.size();
    for (std::size_t i = 0; i < walks.size();) {
      PathWalk& walk = walks[i];
      if (!ends && tracer_.step(walk, scratch.branches)) {
        ++i;
        continue;
      }
      scratch.counts.walk_shadow_rays += walk.shadow_rays;
      const RaySink sink(input_.layers, walk.target, image);
      const Rgb light = (walk.direct.sum() + walk.indirect.sum()) * walk.share;
      sink.add_of_volume(walk.volume, light);
      sink.add_to_piece(walk.piece, light);
      sink.add_sum(&PassImage::direct, walk.direct *= walk.share);
      sink.add_sum(&PassImage::indirect, walk.indirect *= walk.share);
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
