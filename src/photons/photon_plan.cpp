#include "photons/photon_plan.h"

#include "medium/depth_profile.h"
#include "transport/camera_ray.h"
#include "transport/photon_targets.h"
#include "tuning/constants.h"

#include <cmath>

namespace vdbeam {

namespace {

/// The nearest power of the fourth root of two: the same number, and so the same photons, for
/// frames that differ a little.
double in_steps(double number) {
  return number > 0 ? std::exp2(std::round(4 * std::log2(number)) / 4) : 0;
}

/// All volumes have the same albedo, also where a forward peak is taken out.
bool common_albedo(const Medium& medium) {
  for (const Volume& volume : medium.volumes)
    if (volume.color || volume.albedo != medium.volumes[0].albedo ||
        (medium.peak && volume.phase_index != medium.volumes[0].phase_index))
      return false;
  return true;
}

/// Shadow rays of a camera ray by the number of scattering events.
int samples_for(double collisions) {
  const double samples = std::round(tuning::direct_per_collision / (1 + collisions));
  return static_cast<int>(
      std::clamp<double>(samples, tuning::fewest_direct_samples, tuning::most_direct_samples));
}

/// Sum over the photons, mean over the channels.
double total_power(const PhotonList& photons) {
  double sum = 0;
  for (std::size_t i = 0; i < photons.size(); ++i)
    sum += static_cast<double>(mean_component(photons.power[i]));
  return sum;
}

} // namespace

int PhotonPlan::direct_samples_of(float depth) const {
  return std::clamp(samples_for(depth), direct_samples, most_direct_samples);
}

void look_at_rays(const EstimatorInput& input, PhotonPlan& plan) {
  constexpr int samples = 48;
  const Camera& camera = input.camera;
  const bool caustics =
      input.plan.needs(Stage::surface_photons) && input.world.surfaces->throw_light();
  DepthProfile profile;
  double hits = 0, sum = 0, squares = 0;
  std::vector<float> opacities;
  for (int y = 0; y < samples && !input.stopped(); ++y)
    for (int x = 0; x < samples; ++x) {
      const CameraRay ray = camera_ray(
          input.world, camera,
          camera.ray((x + 0.5) * camera.width() / samples, (y + 0.5) * camera.height() / samples));
      profile.build(input.world.medium, ray.segment, 0.5f);
      if (caustics && ray.hit) {
        ++hits;
      } else if (!profile.empty()) {
        opacities.push_back(profile.opacity());
        sum += opacities.back();
        squares += opacities.back() * opacities.back();
      }
    }
  plan.full_opacity = sum > 0 ? tuning::faint_opacity * static_cast<float>(squares / sum) : 0;
  for (const float opacity : opacities)
    hits += plan.effort_of(opacity);
  plan.hits = hits / (samples * samples) * camera.width() * camera.height();
}

PhotonPlan default_photon_plan(const EstimatorInput& input) {
  const RenderSettings& settings = input.settings;
  PhotonPlan plan;
  plan.sampled_lights = input.shadow_ray_lights();
  plan.albedo_in_power =
      settings.store == PhotonStore::scatter || common_albedo(input.world.medium);
  plan.direct_samples =
      settings.direct_samples > 0 ? settings.direct_samples : tuning::most_direct_samples;
  plan.most_direct_samples = plan.direct_samples;
  plan.chooses_direct_samples = settings.direct_samples == 0;
  plan.neighbours = settings.neighbours > 0 ? settings.neighbours : tuning::default_neighbours;
  return plan;
}

TracedPhotons trace_pilot(const EstimatorInput& input, PhotonPlan& plan) {
  const RenderSettings& settings = input.settings;
  PhotonPassSettings pass = pass_settings(input, plan, pilot_pass);
  pass.paths = tuning::pilot_paths;
  pass.caustic_lights = caustic_lights(input.world);
  look_at_rays(input, plan);
  TracedPhotons pilot = trace_photons(input.world, pass);
  if (const double power = total_power(pilot.photons); power > 0)
    plan.caustic_share = total_power(pilot.caustics) / power;
  plan.pilot_paths += pass.paths;
  const double collisions = std::max(1e-3, pilot.mean_collisions);
  plan.collisions_per_path = collisions;
  if (settings.direct_samples == 0) {
    plan.direct_samples = samples_for(collisions);
    // Light of one direction has little noise where the ray is thin.
    const bool extended =
        samples_extended_light(input.world, [&](std::size_t i) { return plan.sampled_lights[i]; });
    plan.most_direct_samples = extended ? tuning::most_direct_samples : plan.direct_samples;
  }
  plan.store_probability = std::min(1.0, tuning::stored_per_path / collisions);
  plan.stored_per_path = collisions * plan.store_probability;
  return pilot;
}

std::uint64_t choose_paths(const RenderSettings& settings, const PhotonPlan& plan) {
  const std::optional<std::uint64_t>& photons = settings.photons;
  return static_cast<std::uint64_t>(std::ceil(
      photons ? paths_for_photons(static_cast<double>(*photons), plan.stored_per_path)
              : automatic_paths(plan.hits, plan.stored_per_path, plan.collisions_per_path)));
}

double automatic_paths(double hits, double stored_per_path, double collisions_per_path) {
  // Paths that meet little cost little, and photons of few of them would have wide kernels.
  const double more = std::clamp(1 / collisions_per_path, 1.0, tuning::most_paths_in_thin_media);
  return std::min(std::max(tuning::fewest_paths, in_steps(tuning::paths_per_hit * hits * more)),
                  tuning::most_photons / stored_per_path);
}

double paths_for_photons(double photons, double stored_per_path) {
  return photons * std::min(1 / stored_per_path, tuning::most_paths_per_photon);
}

bool reach_bounce_limit(const EstimatorInput& input) {
  if (!input.settings.max_bounces || !input.plan.needs(Stage::photons))
    return input.settings.max_bounces.has_value();
  constexpr std::uint64_t probe_paths = 128;
  constexpr double seen_share = 1e-3;
  PhotonPassSettings pass = pass_settings(input, default_photon_plan(input), limit_pass);
  pass.paths = probe_paths;
  pass.store_probability = 0;
  const double within = trace_photons(input.world, pass).mean_collisions;
  pass.max_bounces.reset(); // the same paths, to their end
  const double all = trace_photons(input.world, pass).mean_collisions;
  return all - within > seen_share * all;
}

std::vector<bool> caustic_lights(const World& world) {
  if (!world.surfaces || !world.surfaces->focus_light())
    return {};
  std::vector<bool> caustic(world.lights.size());
  for (std::size_t l = 0; l < caustic.size(); ++l)
    caustic[l] = world.lights[l].is_delta() || world.lights[l].narrow_direction();
  return caustic;
}

PhotonPassSettings pass_settings(const EstimatorInput& input, const PhotonPlan& plan,
                                 std::uint64_t pass) {
  const World& world = input.world;
  PhotonPassSettings settings;
  settings.paths = plan.paths;
  settings.store = input.settings.store;
  settings.store_probability = static_cast<float>(plan.store_probability);
  settings.store_probability_by_cell = plan.store_probability_by_cell;
  if (plan.store_probability_by_cell && sees_directly(world))
    settings.camera = input.camera;
  settings.guide = plan.guide;
  settings.skip_first_flight = plan.sampled_lights;
  settings.max_bounces = input.settings.max_bounces;
  settings.truncation_order = world.medium.peak ? world.medium.peak->order : 0;
  // Without its peak a medium may be isotropic where the scene's is not.
  settings.directions = input.plan.needs(Stage::photon_directions) && !world.medium.isotropic();
  if (plan.albedo_in_power && settings.store == PhotonStore::fluence && !world.medium.empty())
    settings.albedo = world.medium.volumes[0].albedo;
  settings.key = {input.settings.seed, input.frame, pass};
  settings.stop = input.stop;
  return settings;
}

std::vector<bool> lights_of_surfaces(const EstimatorInput& input) {
  std::vector<bool> lights = input.shadow_ray_lights();
  for (std::size_t i = 0; i < input.plan.shadow_ray_lights.size(); ++i)
    lights[i] = lights[i] || input.world.lights.traits(i).wants_shadow_rays;
  return lights;
}

RadiusSettings radius_settings(const EstimatorInput& input, double neighbours, float scale) {
  const World& world = input.world;
  const RenderSettings& settings = input.settings;
  const float world_scale = static_cast<float>(world.space.scale);
  RadiusSettings radii;
  radii.mode = settings.kernel;
  radii.fixed_radius = static_cast<float>(settings.radius) * world_scale;
  radii.neighbours = static_cast<float>(neighbours);
  radii.scale = scale;
  radii.min_radius =
      settings.min_radius > 0 ? static_cast<float>(settings.min_radius) * world_scale : 0;
  // Kernels as wide as the medium would lose most of its light outside.
  radii.max_radius = 0.5f * world.region.radius;
  if (settings.kernel == KernelRadius::fixed)
    radii.max_radius = infinity;
  if (settings.max_radius > 0)
    radii.max_radius = static_cast<float>(settings.max_radius) * world_scale;
  return radii;
}

RadiusSettings surface_radii(const EstimatorInput& input, float scale) {
  RadiusSettings radii = radius_settings(input, tuning::surface_neighbours, scale);
  if (input.settings.kernel == KernelRadius::adaptive && !(input.settings.max_radius > 0))
    radii.max_radius =
        static_cast<float>(tuning::widest_surface_kernel * surface_extent(input.world));
  return radii;
}

} // namespace vdbeam
