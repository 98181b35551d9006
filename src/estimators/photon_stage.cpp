#include "estimators/photon_stage.h"

#include <chrono>

namespace vdbeam {

namespace {

constexpr double default_neighbours = 1000;
constexpr double default_keep = 0.5;
constexpr std::uint64_t default_photons = 400000;
constexpr std::uint64_t first_paths = 20000;

} // namespace

PhotonStage::PhotonStage(const EstimatorInput& input) : input_(input) {
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
  needs_map_ = scatters && world.lights.size() > 0 && !world.medium.empty() &&
               (!single_bounce || photons_for_first_flight);
}

void PhotonStage::choose_counts() {
  const RenderSettings& settings = input_.world.settings;
  direct_samples_ = settings.direct_samples > 0 ? settings.direct_samples : 2;
  keep_ = settings.keep > 0 ? settings.keep : default_keep;
  neighbours_ = settings.neighbours > 0 ? settings.neighbours : default_neighbours;
  target_photons_ = settings.photons.value_or(default_photons);
  paths_ = std::min(first_paths, target_photons_);
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
  if (settings.max_radius > 0)
    radii.max_radius = static_cast<float>(settings.max_radius) * scale;
  return radii;
}

void PhotonStage::shoot(int pass, RenderStatistics& statistics) {
  if (!needs_map_) {
    map_ = PhotonMap::build({}, 1, radii(pass), input_.world.settings.kernel_shape);
    return;
  }
  const auto start = std::chrono::steady_clock::now();
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
  settings.key = {world.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
  PhotonPass photons = trace_photons(world, settings);
  statistics.trace +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  statistics.light_paths += paths_;
  map_ = PhotonMap::build(std::move(photons.photons), world.grey ? 1 : 3, radii(pass),
                          world.settings.kernel_shape);
  statistics.photons_stored += map_.size();
  if (map_.size() > 0)
    statistics.bytes_per_photon = map_.bytes() / map_.size();
  statistics.order += map_.times().order;
  statistics.radii += map_.times().radii;
  statistics.build += map_.times().build;
}

} // namespace vdbeam
