#include "estimators/pilot/beam_plan.h"

#include "estimators/gather/final_gather.h"
#include "estimators/pilot/choose_final_gather.h"
#include "estimators/pilot/fit_path_guide.h"
#include "estimators/pilot/kernel_pilot.h"
#include "photons/kernel_support.h"
#include "photons/view_importance.h"
#include "photons/view_thinning.h"
#include "transport/similar_medium.h"

#include <cmath>
#include <utility>

namespace vdbeam {

namespace {

/// Where the camera sees nothing of a cell, collisions there are stored with at least this share of
/// the probability of those that it sees best.
constexpr float least_importance = 1.0f / 1024;
/// Kernels are tried on maps of this share of a pass's light paths, but no more paths than these;
/// where passes are small, of twice the share up to so many.
constexpr double trial_share = 0.125;
constexpr double few_trial_paths = 5000, most_trial_paths = 40000;
constexpr int trial_maps = 6;
/// Paths that tell how many photons guided paths leave, and where.
constexpr std::uint64_t guided_pilot_paths = 1024;
/// Photons in the narrow kernels of the trial, for a whole pass; the wide ones hold more. They lie
/// about what is chosen in the end, so that little is extrapolated (docs/decisions.md).
constexpr double trial_neighbours = 600;
constexpr double wide_over_narrow = 4;
/// A narrow kernel holds at most this share of a map, so that a wide one fits.
constexpr double most_in_kernel = 1.0 / 16;
/// Below this many photons per pass the trial is too noisy, and the default is used.
constexpr double fewest_for_trial = 500;

/// The nearest of 640, twice and half of that and so on: what the trial finds scatters, and kernels
/// that changed with that from frame to frame would flicker. Most clouds need 500 to 800, in the
/// middle of a step. One step is a factor of 1.26 in the radius. More than 1280 gained little in
/// any cloud, and kernels many mean free paths wide have a bias that the trial does not show.
double in_kernel_steps(double neighbours) {
  constexpr double middle = 640, most = 1280;
  return std::min(most, middle * std::exp2(std::round(std::log2(neighbours / middle))));
}

/// About the radius that kernels would have without regard to the view.
float typical_radius(const EstimatorInput& input, const PhotonPlan& plan, const PhotonList& pilot) {
  constexpr std::size_t enough = 8192;
  const std::size_t stride = (pilot.size() + enough - 1) / enough;
  PhotonList sample;
  for (std::size_t i = 0; i < pilot.size(); i += stride) {
    sample.position.push_back(pilot.position[i]);
    sample.power.push_back(pilot.power[i]);
  }
  RadiusSettings radii = radius_settings(input, plan, 0);
  const double photons =
      plan.stored_per_path * static_cast<double>(choose_paths(input, plan.stored_per_path));
  radii.neighbours *= static_cast<float>(static_cast<double>(sample.size()) / photons);
  return PhotonMap::build(std::move(sample), 1, radii, KernelShape::biweight).mean_radius();
}

/// All collisions of a sample of the paths that the plan has so far.
TracedPhotons trace_guided_pilot(const EstimatorInput& input, PhotonPlan& plan) {
  PhotonPassSettings pass = pass_settings(input, plan, guided_pilot_pass);
  pass.paths = guided_pilot_paths;
  pass.store_probability = 1;
  plan.pilot_paths += pass.paths;
  return trace_photons(input.world, pass);
}

/// Sends light paths to where the camera sees them, and stores their collisions there.
void follow_view(const EstimatorInput& input, TracedPhotons pilot, PhotonPlan& plan) {
  const auto wanted_per_path = [&] {
    const double collisions = pilot.mean_collisions;
    return std::min(collisions, std::max(stored_per_path_aim, std::sqrt(collisions)));
  };
  plan.stored_per_path = wanted_per_path();
  plan.view_reach = typical_radius(input, plan, pilot.photons);
  CellTables importance = view_importance(input.world, input.camera, plan.view_reach,
                                          least_importance, plan.importance_rays);
  if (input.settings.store == PhotonStore::fluence)
    plan.guide = fit_path_guide(input, plan, importance, pilot.mean_collisions);
  if (plan.guide) {
    pilot = trace_guided_pilot(input, plan);
    plan.stored_per_path = wanted_per_path();
  }
  if (pilot.photons.size() == 0) // only where a pilot was stopped
    return;
  ViewThinning thinning =
      thin_by_view(input.world, input.camera, std::move(importance), pilot.photons,
                   std::max(1e-3, pilot.mean_collisions), plan.stored_per_path);
  plan.store_probability_by_cell =
      std::make_shared<const CellTables>(std::move(thinning.store_probability));
  plan.stored_per_path = thinning.stored_per_path;
  plan.view_factor = thinning.factor;
}

/// Whether the moment's photons can follow the plan of the scene: they have the same lights, and
/// lengths of the same unit.
bool may_follow(const EstimatorInput& input, const ScenePhotons& scene) {
  return scene.space.scale == input.world.space.scale &&
         (!scene.plan.guide || scene.plan.guide->light_shares.size() == input.world.lights.size());
}

/// The plan of the scene itself, put where the moment's render space has it. What is stored follows
/// the moment's own cells.
PhotonPlan follow_scene(const EstimatorInput& input, const ScenePhotons& scene) {
  PhotonPlan plan = scene.plan;
  plan.pilot_paths = plan.importance_rays = 0;
  if (plan.guide) {
    const Vec3d by = (scene.space.origin - input.world.space.origin) * scene.space.scale;
    auto guide = std::make_shared<PathGuide>(*plan.guide);
    guide->blocks.move(Vec3f(by));
    plan.guide = std::move(guide);
  }
  if (plan.store_probability_by_cell)
    plan.store_probability_by_cell = std::make_shared<const CellTables>(
        store_by_view(view_importance(input.world, input.camera, plan.view_reach, least_importance,
                                      plan.importance_rays),
                      plan.view_factor));
  return plan;
}

/// Chooses the neighbours at which pictures of narrow and wide kernels tell that the error is
/// least.
void try_kernels(const EstimatorInput& input, PhotonPlan& plan) {
  const World& world = input.world;
  const KernelShare share = boundary_share(input, KernelDomain::disc);
  const double paths = static_cast<double>(plan.paths), photons = plan.stored_per_path * paths;
  const double trial_paths = std::ceil(std::clamp(
      trial_share * paths, std::min(few_trial_paths, 2 * trial_share * paths), most_trial_paths));
  KernelTrial narrow, wide;
  narrow.neighbours = std::min(trial_neighbours, most_in_kernel * photons);
  wide.neighbours = wide_over_narrow * narrow.neighbours;
  RngKey key;
  for (std::uint64_t i = 1; i <= trial_maps; ++i) {
    PhotonPassSettings settings = pass_settings(input, plan, pilot_pass - i);
    settings.paths = static_cast<std::uint64_t>(trial_paths);
    key = settings.key;
    const TracedPhotons traced = trace_photons(world, settings);
    plan.pilot_paths += settings.paths;
    plan.collisions_per_path += traced.mean_collisions / trial_maps;
    if (input.stopped())
      return;
    for (KernelTrial* trial : {&narrow, &wide}) {
      RadiusSettings radii = radius_settings(input, plan, 0);
      radii.neighbours = static_cast<float>(trial->neighbours * trial_paths / paths);
      trial->maps.push_back(PhotonMap::build(traced.photons, input.photon_channels(), radii,
                                             input.settings.kernel_shape));
      fit_kernels(world, share, trial->maps.back());
    }
  }
  const KernelErrors errors = measure_kernels(input, plan, narrow, wide, key, plan.importance_rays);
  const KernelModel model(narrow, wide, errors, trial_paths / paths, input.settings.alpha);
  plan.neighbours = in_kernel_steps(model.best_neighbours());
  plan.trial = std::make_shared<const KernelTrialResult>(
      KernelTrialResult{model, errors.pixels, errors.sharing});
  plan.walks = choose_final_gather(input, plan, narrow, trial_paths / paths);
}

} // namespace

ScenePhotons plan_scene_photons(const EstimatorInput& input) {
  PassWorlds worlds(input.world, default_photon_plan(input).similar);
  return {plan_beam_photons(input.in(worlds.of(0))), input.world.space};
}

PhotonPlan plan_beam_photons(const EstimatorInput& input) {
  if (input.of_scene && may_follow(input, *input.of_scene))
    return follow_scene(input, *input.of_scene);
  PhotonPlan plan = default_photon_plan(input);
  if (!input.plan.needs(Stage::photons))
    return plan_photons(input);
  TracedPhotons pilot = trace_pilot(input, plan);
  if (input.plan.needs(Stage::photon_importance) && pilot.photons.size() > 0)
    follow_view(input, std::move(pilot), plan);
  plan.paths = choose_paths(input, plan.stored_per_path);
  const double photons = plan.stored_per_path * static_cast<double>(plan.paths);
  if (input.plan.needs(Stage::kernel_pilot) && photons >= fewest_for_trial)
    try_kernels(input, plan);
  if (input.settings.final_gather == FinalGathering::always && !plan.walks &&
      may_gather_finally(input, plan))
    plan.walks.emplace();
  return plan;
}

} // namespace vdbeam
