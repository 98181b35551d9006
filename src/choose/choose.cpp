#include "choose/choose.h"

#include "choose/feature.h"
#include "choose/pilot/choose_gather.h"
#include "choose/pilot/fit_path_guide.h"
#include "choose/pilot/kernel_pilot.h"
#include "choose/schedule.h"
#include "photons/hidden_lights.h"
#include "photons/kernel_support.h"
#include "photons/view_importance.h"
#include "photons/view_thinning.h"
#include "tuning/constants.h"

#include <cmath>
#include <utility>

namespace vdbeam {

namespace {

/// The nearest of a number, twice and half of that and so on: what the trial finds scatters, and
/// kernels that changed with that from frame to frame would flicker. One step is a factor of 1.26
/// in the radius.
double in_kernel_steps(double neighbours) {
  return std::min(tuning::most_neighbours,
                  tuning::most_neighbours *
                      std::exp2(std::round(std::log2(neighbours / tuning::most_neighbours))));
}

/// About the radius that kernels would have without regard to the view.
float typical_radius(const EstimatorInput& input, const PhotonPlan& plan, const PhotonList& pilot) {
  const std::size_t stride =
      (pilot.size() + tuning::photons_for_radius - 1) / tuning::photons_for_radius;
  PhotonList sample;
  for (std::size_t i = 0; i < pilot.size(); i += stride) {
    sample.position.push_back(pilot.position[i]);
    sample.power.push_back(pilot.power[i]);
    if (!pilot.part.empty())
      sample.part.push_back(pilot.part[i]);
  }
  RadiusSettings radii = radius_settings(input, plan.neighbours);
  const double photons =
      plan.stored_per_path * static_cast<double>(choose_paths(input.settings, plan));
  radii.neighbours *= static_cast<float>(static_cast<double>(sample.size()) / photons);
  return PhotonMap::build(std::move(sample), 1, radii, KernelShape::biweight).mean_radius();
}

/// All collisions of a sample of the paths that the plan has so far.
TracedPhotons trace_guided_pilot(const EstimatorInput& input, PhotonPlan& plan) {
  PhotonPassSettings pass = pass_settings(input, plan, guided_pilot_pass);
  pass.paths = tuning::guided_pilot_paths;
  pass.store_probability = 1;
  plan.pilot_paths += pass.paths;
  return trace_photons(input.world, pass);
}

/// What pilots have counted so far.
PilotWork work_so_far(const PhotonPlan& plan) {
  return {plan.pilot_paths, plan.importance_rays};
}

/// Sends light paths to where the camera sees them, and stores their collisions there.
void follow_view(const EstimatorInput& input, const EstimatorKind& kind, TracedPhotons pilot,
                 Choices& choices) {
  PhotonPlan& plan = choices.photons;
  const PilotWork before_view = work_so_far(plan);
  const auto wanted_per_path = [&] {
    const double collisions = pilot.mean_collisions;
    return std::min(collisions, std::max(tuning::stored_per_path, std::sqrt(collisions)));
  };
  plan.stored_per_path = wanted_per_path();
  plan.view_reach = typical_radius(input, plan, pilot.photons);
  CellTables importance =
      view_importance(input.world, input.camera, plan.view_reach, tuning::least_importance,
                      plan.importance_rays, input.stop);
  choices.view_work = work_so_far(plan) - before_view;
  const PilotWork before_guide = work_so_far(plan);
  if (is_possible(path_guide_feature, {input, kind}))
    plan.guide = fit_path_guide(input, plan, importance, pilot.mean_collisions);
  if (plan.guide) {
    pilot = trace_guided_pilot(input, plan);
    plan.collisions_per_path = pilot.mean_collisions;
    plan.stored_per_path = wanted_per_path();
  }
  choices.guide_work = work_so_far(plan) - before_guide;
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
bool may_follow(const EstimatorInput& input, const SceneChoices& scene) {
  const auto& guide = scene.choices.photons.guide;
  return scene.space.scale == input.world.space.scale &&
         (!guide || guide->light_shares.size() == input.world.lights.size());
}

/// The choices of the scene itself, put where the moment's render space has them. What is stored
/// follows the moment's own cells.
void follow_scene(const EstimatorInput& input, const SceneChoices& scene, Choices& choices) {
  const PeakOrders own = choices.peak;
  choices = scene.choices;
  choices.peak = own;
  PhotonPlan& plan = choices.photons;
  plan.pilot_paths = plan.importance_rays = 0;
  if (plan.guide) {
    const Vec3d by = (scene.space.origin - input.world.space.origin) * scene.space.scale;
    auto guide = std::make_shared<PathGuide>(*plan.guide);
    guide->blocks.move(Vec3f(by));
    plan.guide = std::move(guide);
  }
  if (plan.store_probability_by_cell)
    plan.store_probability_by_cell = std::make_shared<const CellTables>(
        store_by_view(view_importance(input.world, input.camera, plan.view_reach,
                                      tuning::least_importance, plan.importance_rays, input.stop),
                      plan.view_factor));
}

/// Chooses the neighbours at which the error of trial pictures in narrow and wide kernels is least,
/// and whether to use final gathering.
void try_kernels(const EstimatorInput& input, const EstimatorKind& kind, Choices& choices) {
  PhotonPlan& plan = choices.photons;
  const World& world = input.world;
  const double paths = static_cast<double>(plan.paths), photons = plan.stored_per_path * paths;
  const double trial_paths =
      std::ceil(std::clamp(tuning::trial_share * paths,
                           std::min(tuning::few_trial_paths, 2 * tuning::trial_share * paths),
                           tuning::most_trial_paths));
  plan.collisions_per_path = 0;
  const PilotWork before = work_so_far(plan);
  KernelTrial narrow, wide;
  narrow.neighbours = std::min(tuning::trial_neighbours, tuning::most_in_kernel * photons);
  wide.neighbours = tuning::wide_over_narrow * narrow.neighbours;
  RngKey key;
  for (int i = 1; i <= tuning::trial_maps; ++i) {
    PhotonPassSettings settings =
        pass_settings(input, plan, pilot_pass - static_cast<std::uint64_t>(i));
    settings.paths = static_cast<std::uint64_t>(trial_paths);
    key = settings.key;
    const TracedPhotons traced = trace_photons(world, settings);
    plan.pilot_paths += settings.paths;
    plan.collisions_per_path += traced.mean_collisions / tuning::trial_maps;
    if (input.stopped())
      return;
    for (KernelTrial* trial : {&narrow, &wide}) {
      RadiusSettings radii = radius_settings(input, plan.neighbours);
      radii.neighbours = static_cast<float>(trial->neighbours * trial_paths / paths);
      trial->maps.push_back(PhotonMap::build(traced.photons, input.photon_channels(), radii,
                                             input.settings.kernel_shape));
      fit_kernels(input, KernelDomain::disc, true, trial->maps.back());
    }
  }
  const KernelErrors errors = measure_kernels(input, plan, narrow, wide, key, plan.importance_rays);
  choices.kernel_work = work_so_far(plan) - before;
  const KernelModel model(narrow, wide, errors, trial_paths / paths, input.settings.alpha);
  plan.neighbours = in_kernel_steps(model.best_neighbours());
  choices.trial = std::make_shared<const KernelTrialResult>(
      KernelTrialResult{model, errors.pixels, errors.regression});
  const GatherChoice gather = choose_gather(input, kind, choices, narrow, trial_paths / paths);
  choices.gather = gather.plan;
  choices.lead_of_gather = gather.lead;
}

/// Chooses lights, photons, kernels and gathering for an estimator that shoots photons, in the
/// world of the first pass.
void choose_photons(const EstimatorInput& input, const EstimatorKind& kind, Choices& choices) {
  PhotonPlan& plan = choices.photons;
  plan = default_photon_plan(input);
  if (!input.plan.needs(Stage::photons)) {
    if (input.plan.needs(Stage::surface_photons)) {
      look_at_rays(input, plan);
      plan.paths = choose_paths(input.settings, plan);
    }
    return;
  }
  TracedPhotons pilot = trace_pilot(input, plan);
  if (input.plan.needs(Stage::photon_importance) && pilot.photons.size() > 0)
    follow_view(input, kind, std::move(pilot), choices);
  plan.paths = choose_paths(input.settings, plan);
  const double photons = plan.stored_per_path * static_cast<double>(plan.paths);
  if (input.plan.needs(Stage::kernel_pilot) && photons >= tuning::fewest_for_trial)
    try_kernels(input, kind, choices);
  const FeatureFacts facts(input, kind, plan.sampled_lights);
  if (!choices.gather && kind.gathers() && is_possible(final_gather_feature, facts))
    choices.gather.emplace();
  plan.share_at_boundary = is_possible(boundary_share_feature, facts);
  // Not before gathering is chosen, whose walks look for all lights: where one is found by photons
  // only, because surfaces hide it, nothing is lost along camera rays.
  if (!choices.gather)
    plan.sampled_lights = lights_in_sight(input, std::move(plan.sampled_lights));
}

/// The choices about light; those about the shutter and surfaces are the caller's.
Choices choose_light(const EstimatorInput& input, const EstimatorKind& kind, PassWorlds& worlds) {
  Choices choices;
  choices.estimator = kind.name;
  if (!kind.shoots_photons())
    return choices;
  choices.peak = choose_peak(input, kind);
  const EstimatorInput first = input.in(planned_world(choices.peak, worlds));
  if (input.of_scene && may_follow(first, *input.of_scene))
    follow_scene(first, *input.of_scene, choices);
  else
    choose_photons(first, kind, choices);
  PhotonPlan& plan = choices.photons;
  if (choices.gather)
    choices.estimator = EstimatorType::gather.name;
  else if (kind.may_gather())
    choices.estimator = EstimatorType::beam.name;
  plan.shadow_lattices = is_possible(shadow_lattice_feature, {first, kind, plan.sampled_lights});
  return choices;
}

} // namespace

SceneChoices SceneChoices::in_units(double scale) const {
  SceneChoices result = *this;
  const auto factor = static_cast<float>(scale / space.scale);
  if (factor == 1)
    return result;
  result.space.scale = scale;
  result.choices.photons.view_reach *= factor;
  if (const auto& guide = choices.photons.guide)
    result.choices.photons.guide = std::make_shared<const PathGuide>(guide->in_units(factor));
  return result;
}

PeakOrders choose_peak(const EstimatorInput& input, const EstimatorKind& kind) {
  return is_possible(forward_peak_feature, {input, kind}) ? choose_peak_orders(input.world.medium)
                                                          : PeakOrders();
}

const World& planned_world(const PeakOrders& peak, PassWorlds& worlds) {
  return worlds.of(peak_order(peak, 0, false));
}

Choices choose(const EstimatorInput& input, const EstimatorKind& kind, PassWorlds& worlds) {
  Choices choices = choose_light(input, kind, worlds);
  choices.motion_samples = input.plan.motion_samples;
  choices.fits_surfaces = kind.shoots_photons() && input.world.surfaces;
  return choices;
}

SceneChoices choose_for_scene(const EstimatorInput& input, const EstimatorKind& kind) {
  PassWorlds worlds(input.world);
  return {choose(input, kind, worlds), input.world.space};
}

} // namespace vdbeam
