#include "estimators/photon_stage.h"

#include "estimators/kernel_pilot.h"
#include "estimators/photon_cache.h"
#include "estimators/view_importance.h"
#include "estimators/view_thinning.h"

#include <chrono>
#include <cmath>
#include <utility>

namespace vdbeam {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Where no pilot chooses them.
constexpr double default_neighbours = 500;
/// Collisions of one path that are kept on average: more of them tell little that is new.
constexpr double kept_per_path = 4;
/// Light paths per camera ray that meets the medium: where tracing and gathering balance, measured
/// on thin and on thick media (docs/decisions.md). A count, not a clock, so that every machine
/// chooses the same.
constexpr double paths_per_hit = 2;
constexpr double fewest_paths = 10000;
constexpr double most_photons = 2e6;
/// Light paths per photon asked for: in a medium so thin that more would be needed, photons are
/// few.
constexpr double most_paths_per_photon = 16;
/// Shadow rays per camera ray: in thin media, where single scattering is most of the light, its
/// noise is most of the error; in thick ones the photons' noise hides it (docs/decisions.md).
constexpr double direct_per_path = 12;
constexpr int most_direct_samples = 6;
/// Where the camera sees nothing of a photon, at least this share of those like it is stored.
constexpr float least_importance = 1.0f / 1024;
constexpr std::uint64_t pilot_paths = 1024;
constexpr std::uint64_t pilot_pass = ~std::uint64_t(0);
/// Kernels are tried on maps of this share of a pass's light paths, but no more paths than these.
constexpr double trial_share = 0.25;
constexpr double most_trial_paths = 25000;
constexpr int trial_maps = 4;
/// Photons in the narrow kernels of the trial, for a whole pass; the wide ones are twice as wide.
constexpr double trial_neighbours = 1000;
constexpr double wide_over_narrow = 8;
/// A narrow kernel holds at most this share of a map, so that a wide one fits.
constexpr double most_in_kernel = 1.0 / 16;
/// Fewer photons than these in a pass cannot be told anything by.
constexpr double fewest_for_trial = 500;

/// The nearest power of the fourth root of two: the same number, and so the same photons, for
/// frames that differ a little.
double in_steps(double number) {
  return number > 0 ? std::exp2(std::round(4 * std::log2(number)) / 4) : 0;
}

/// The nearest of 34, 170, 850, 4250, ...: what the pilot finds scatters by a factor of 1.7 either
/// way, and kernels that changed with that from frame to frame would flicker.
double in_kernel_steps(double neighbours) {
  return 850 * std::pow(5, std::round(std::log(neighbours / 850) / std::log(5)));
}

/// Camera rays of a pass that meet the medium, from a coarse sample.
double count_hits(const EstimatorInput& input) {
  constexpr int samples = 48;
  const Camera& camera = input.camera;
  DepthProfile profile;
  int hits = 0;
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x) {
      const CameraRay ray = camera_ray(input.world, camera, (x + 0.5) * camera.width() / samples,
                                       (y + 0.5) * camera.height() / samples);
      profile.build(input.world.medium, ray.ray, ray.t_begin, ray.t_end, 0.5f);
      hits += !profile.empty();
    }
  return static_cast<double>(hits) / (samples * samples) * camera.width() * camera.height();
}

bool thins_by_view(const RenderSettings& settings) {
  return settings.estimator == EstimatorType::beam && settings.thinning != PhotonThinning::even &&
         !(settings.keep > 0);
}

} // namespace

PhotonStage::PhotonStage(const EstimatorInput& input)
    : input_(input), support_(input.world.medium, input.camera.origin()) {
  const std::vector<Volume>& volumes = input_.world.medium.volumes;
  common_albedo_ = true;
  for (const Volume& volume : volumes)
    common_albedo_ = common_albedo_ && volume.albedo == volumes[0].albedo;
  choose_lights();
  choose_counts();
}

void PhotonStage::choose_lights() {
  const World& world = input_.world;
  bool photons_for_first_flight = false;
  for (std::size_t i = 0; i < world.lights.size(); ++i) {
    DirectLight direct = world.lights[i].direct;
    if (direct == DirectLight::automatic)
      direct = world.settings.direct;
    if (direct == DirectLight::automatic)
      direct = world.lights[i].wants_shadow_rays() ? DirectLight::sampled : DirectLight::photons;
    sampled_.push_back(direct == DirectLight::sampled);
    photons_for_first_flight = photons_for_first_flight || direct == DirectLight::photons;
  }
  bool scatters = false;
  for (const Volume& volume : world.medium.volumes)
    scatters = scatters || max_component(volume.albedo) > 0;
  const bool single_bounce = world.settings.max_bounces && *world.settings.max_bounces <= 1;
  needs_map_ = scatters && world.lights.size() > 0 && may_see_medium(world, input_.camera) &&
               (!single_bounce || photons_for_first_flight);
}

void PhotonStage::choose_counts() {
  const RenderSettings& settings = input_.world.settings;
  direct_samples_ = settings.direct_samples > 0 ? settings.direct_samples : most_direct_samples;
  neighbours_ = settings.neighbours > 0 ? settings.neighbours : default_neighbours;
  if (!needs_map_)
    return;
  PhotonPassSettings pilot = pass_settings(pilot_pass);
  pilot.paths = pilot_paths;
  const PhotonPass sample = trace_photons(input_.world, pilot);
  const double collisions = std::max(1e-3, sample.mean_collisions);
  if (settings.direct_samples == 0)
    direct_samples_ = std::clamp(static_cast<int>(std::lround(direct_per_path / (1 + collisions))),
                                 1, most_direct_samples);
  keep_ = settings.keep > 0 ? settings.keep : std::min(1.0, kept_per_path / collisions);
  stored_per_path_ = collisions * keep_;
  if (thins_by_view(settings) && sample.photons.size() > 0)
    choose_thinning(sample);
  paths_ = choose_paths();
  if (may_try_kernels())
    choose_neighbours();
}

/// Where photons may be kept for frames with other views, kernels must not depend on the view
/// either.
bool PhotonStage::may_try_kernels() const {
  const RenderSettings& settings = input_.world.settings;
  return thins_by_view(settings) && settings.neighbours == 0 &&
         settings.kernel == KernelRadius::adaptive && settings.store == PhotonStore::fluence &&
         stored_per_path_ * static_cast<double>(paths_) >= fewest_for_trial;
}

void PhotonStage::choose_neighbours() {
  const World& world = input_.world;
  const double paths = static_cast<double>(paths_), photons = stored_per_path_ * paths;
  const double trial_paths = std::ceil(std::min(most_trial_paths, trial_share * paths));
  KernelTrial narrow, wide;
  narrow.neighbours = std::min(trial_neighbours, most_in_kernel * photons);
  wide.neighbours = wide_over_narrow * narrow.neighbours;
  RngKey key;
  for (std::uint64_t i = 1; i <= trial_maps; ++i) {
    PhotonPassSettings settings = pass_settings(pilot_pass - i);
    settings.paths = static_cast<std::uint64_t>(trial_paths);
    key = settings.key;
    const PhotonPass pass = trace_photons(world, settings);
    for (KernelTrial* trial : {&narrow, &wide}) {
      RadiusSettings radius_settings = radii(0);
      radius_settings.neighbours = static_cast<float>(trial->neighbours * trial_paths / paths);
      trial->maps.push_back(PhotonMap::build(pass.photons, world.grey ? 1 : 3, radius_settings,
                                             world.settings.kernel_shape));
    }
  }
  const KernelErrors errors =
      measure_kernels(input_, narrow, wide, albedo_in_power(), sampled_, key, importance_rays_);
  const double best =
      best_neighbours(narrow, wide, errors, trial_paths / paths, world.settings.alpha);
  neighbours_ = std::min(wide.neighbours, in_kernel_steps(best));
}

std::uint64_t PhotonStage::choose_paths() const {
  const RenderSettings& settings = input_.world.settings;
  double paths = static_cast<double>(settings.photons.value_or(0)) *
                 std::min(1 / stored_per_path_, most_paths_per_photon);
  if (!settings.photons)
    paths = std::min(std::max(fewest_paths, in_steps(paths_per_hit * count_hits(input_))),
                     most_photons / stored_per_path_);
  return static_cast<std::uint64_t>(std::ceil(paths));
}

void PhotonStage::choose_thinning(const PhotonPass& pilot) {
  const double collisions = pilot.mean_collisions;
  stored_per_path_ = std::min(collisions, std::max(kept_per_path, std::sqrt(collisions)));
  CellTables importance = view_importance(input_.world, input_.camera, kernel_reach(pilot.photons),
                                          least_importance, importance_rays_);
  ViewThinning thinning = thin_by_view(input_.world, std::move(importance), pilot.photons,
                                       collisions, stored_per_path_);
  keep_by_cell_ = std::make_shared<const CellTables>(std::move(thinning.keep));
  stored_per_path_ = thinning.stored_per_path;
}

/// About the radius that kernels would have without regard to the view.
float PhotonStage::kernel_reach(const PhotonList& pilot) const {
  constexpr std::size_t enough = 8192;
  const std::size_t stride = (pilot.size() + enough - 1) / enough;
  PhotonList sample;
  for (std::size_t i = 0; i < pilot.size(); i += stride) {
    sample.position.push_back(pilot.position[i]);
    sample.power.push_back(pilot.power[i]);
  }
  RadiusSettings settings = radii(0);
  const double photons = stored_per_path_ * static_cast<double>(choose_paths());
  settings.neighbours *= static_cast<float>(static_cast<double>(sample.size()) / photons);
  settings.support = nullptr;
  return PhotonMap::build(std::move(sample), 1, settings, KernelShape::biweight).mean_radius();
}

PhotonPassSettings PhotonStage::pass_settings(std::uint64_t pass) const {
  const World& world = input_.world;
  PhotonPassSettings settings;
  settings.paths = paths_;
  settings.store = world.settings.store;
  settings.keep = static_cast<float>(keep_);
  settings.skip_first_flight = sampled_;
  settings.max_bounces = world.settings.max_bounces;
  settings.directions = !world.medium.isotropic();
  if (common_albedo_ && settings.store == PhotonStore::fluence)
    settings.factor = world.medium.volumes[0].albedo;
  settings.key = {world.settings.seed, input_.frame, pass};
  settings.keep_by_cell = keep_by_cell_;
  settings.stop = input_.stop;
  return settings;
}

float PhotonStage::radius_scale(int pass, double alpha) {
  double squared = 1;
  for (int i = 1; i <= pass; ++i)
    squared *= (i + alpha) / (i + 1);
  return static_cast<float>(std::sqrt(squared));
}

RadiusSettings PhotonStage::radii(int pass) const {
  const RenderSettings& settings = input_.world.settings;
  const float scale = static_cast<float>(input_.world.space.scale);
  RadiusSettings radii;
  radii.mode = settings.kernel;
  radii.fixed_radius = static_cast<float>(settings.radius) * scale;
  radii.neighbours = static_cast<float>(neighbours_);
  radii.scale = radius_scale(pass, settings.alpha);
  radii.min_radius = settings.min_radius > 0 ? static_cast<float>(settings.min_radius) * scale : 0;
  // Kernels as wide as the medium would lose most of its light outside.
  radii.max_radius = 0.5f * input_.world.region.radius;
  if (settings.kernel == KernelRadius::fixed)
    radii.max_radius = infinity;
  if (settings.max_radius > 0)
    radii.max_radius = static_cast<float>(settings.max_radius) * scale;
  // The share is that of a positive kernel; a kernel of fourth order, whose rim is negative, would
  // gain bias by it.
  if (settings.store == PhotonStore::fluence && settings.kernel_shape != KernelShape::fourth_order)
    radii.support = [this](const Vec3f& photon, float radius) {
      return input_.world.settings.estimator == EstimatorType::march
                 ? support_.ball_share(photon, radius)
                 : support_.disc_share(photon, radius);
    };
  return radii;
}

void PhotonStage::shoot(int pass, RenderStatistics& statistics) {
  if (!needs_map_) {
    map_ = PhotonMap::build({}, 1, radii(pass), input_.world.settings.kernel_shape);
    return;
  }
  const World& world = input_.world;
  const PhotonPassSettings settings = pass_settings(static_cast<std::uint64_t>(pass));
  statistics.importance_rays += std::exchange(importance_rays_, 0);
  RadiusSettings radius_settings = radii(pass);
  // The share of kernels inside the medium depends on the camera; all before it does not.
  const KernelShare support = std::exchange(radius_settings.support, nullptr);
  if (const auto kept = input_.photons ? input_.photons->find(settings, neighbours_) : nullptr) {
    map_ = kept->copy();
    ++statistics.maps_reused;
  } else {
    make_map(settings, radius_settings, statistics);
  }
  const auto start = Clock::now();
  if (support)
    map_.divide_power(support);
  statistics.radii += seconds_since(start);
  statistics.photons_stored += map_.size();
  if (world.settings.kernel == KernelRadius::adaptive)
    statistics.neighbourhoods += map_.size();
  statistics.neighbours = world.settings.kernel == KernelRadius::adaptive ? neighbours_ : 0;
  if (map_.has_directions())
    statistics.directions += map_.size();
  if (map_.size() > 0)
    statistics.bytes_per_photon = map_.bytes() / map_.size();
}

/// Traces the photons and builds their map.
void PhotonStage::make_map(const PhotonPassSettings& settings, const RadiusSettings& radii,
                           RenderStatistics& statistics) {
  const auto start = Clock::now();
  const World& world = input_.world;
  PhotonPass photons = trace_photons(world, settings);
  statistics.trace += seconds_since(start);
  const bool stopped = input_.stopped();
  if (stopped)
    photons = {}; // of an abandoned pass, nobody needs the map
  statistics.light_paths += settings.paths;
  map_ = PhotonMap::build(std::move(photons.photons), world.grey ? 1 : 3, radii,
                          world.settings.kernel_shape);
  statistics.order += map_.times().order;
  statistics.radii += map_.times().radii;
  statistics.build += map_.times().build;
  if (input_.photons && !stopped)
    input_.photons->keep(settings, neighbours_, map_);
}

} // namespace vdbeam
