#include "choose/feature.h"
#include "walks/light_branches.h"

#include <algorithm>

namespace vdbeam {

namespace {

using Facts = FeatureFacts;

bool stores_scattered_flux(const Facts& facts) {
  return facts.input.settings.store == PhotonStore::scatter;
}
bool limits_bounces(const Facts& facts) {
  return facts.input.settings.max_bounces && facts.input.reaches_bounce_limit;
}
bool shoots_no_photons(const Facts& facts) {
  return !facts.kind.shoots_photons();
}
bool is_forced(const Facts& facts) {
  return forces_final_gather(facts.kind, facts.input.settings);
}
bool gathers_along_rays(const Facts& facts) {
  return facts.kind.name != EstimatorType::automatic.name && !is_forced(facts);
}

/// Removing the peak is valid only if every light has shadow rays or is a constant sky; otherwise
/// light that is scattered by the peak alone is lost.
bool has_light_that_loses_its_peak(const Facts& facts) {
  const LightSet& lights = facts.input.world.lights;
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (!facts.sampled_lights[i] && !lights.traits(i).is_emission &&
        (!lights.traits(i).surrounds || lights.traits(i).wants_shadow_rays))
      return true;
  return false;
}

/// Walks meet no light that has but one point or direction.
bool has_light_that_walks_miss(const Facts& facts) {
  const LightSet& lights = facts.input.world.lights;
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (!facts.sampled_lights[i] && lights[i].is_delta())
      return true;
  return false;
}

/// A small light without shadow rays is met by chance only: rare and bright values, which a pilot
/// would miss.
bool has_light_that_pilots_miss(const Facts& facts) {
  if (is_forced(facts))
    return false;
  const LightSet& lights = facts.input.world.lights;
  for (std::size_t l = 0; l < facts.input.plan.shadow_ray_lights.size(); ++l) {
    const LightTraits& traits = lights.traits(l);
    if (!facts.sampled_lights[l] && (!traits.surrounds || traits.wants_shadow_rays))
      return true;
  }
  return false;
}

/// Whether shadow rays look for a light that `is_wanted`.
template <class Predicate>
bool samples_light(const Facts& facts, const Predicate& is_wanted) {
  const LightSet& lights = facts.input.world.lights;
  for (std::size_t l = 0; l < lights.size(); ++l)
    if (facts.sampled_lights[l] && is_wanted(lights[l]))
      return true;
  return false;
}

bool has_no_narrow_light(const Facts& facts) {
  return !samples_light(facts, LightBranches::is_narrow);
}

bool has_nothing_to_branch_for(const Facts& facts) {
  const World& world = facts.input.world;
  return !LightBranches::has_sharp_peak(world.medium) &&
         !LampShells(world, facts.sampled_lights).any();
}

constexpr std::string_view by_scattered_flux = "photons store scattered flux (render.store)";
constexpr std::string_view by_bounces = "render.max_bounces limits the scattering events";

} // namespace

bool forces_final_gather(const EstimatorKind& kind, const RenderSettings& settings) {
  const bool asked =
      settings.final_gather == FinalGathering::always &&
      (kind.name == EstimatorType::automatic.name || kind.name == EstimatorType::beam.name);
  return kind.name == EstimatorType::gather.name || asked;
}

const Feature view_importance_feature{.name = "view importance",
                                      .key = "render.thinning",
                                      .help =
                                          "photons are stored by their importance for the camera",
                                      .stage = Stage::photon_importance,
                                      .conditions = {}};

namespace {
constexpr FeatureCondition path_guide_conditions[] = {{stores_scattered_flux, by_scattered_flux}};
}
const Feature path_guide_feature{
    .name = "path guide",
    .key = "",
    .help = "light paths are started, split and ended by their importance for the image",
    .stage = Stage::photon_importance,
    .conditions = path_guide_conditions,
    .used = [](const Facts&, const Choices& choices) { return choices.photons.guide != nullptr; },
    .unused = "the pilot stored too few photons to estimate importance"};

const Feature kernel_pilot_feature{
    .name = "kernel pilot",
    .key = "render.neighbours",
    .help = "the kernel width balances noise and bias, measured on small photon maps",
    .stage = Stage::kernel_pilot,
    .conditions = {},
    .used = [](const Facts&, const Choices& choices) { return choices.trial != nullptr; },
    .unused = "there are too few photons for a pilot"};

namespace {
constexpr FeatureCondition forward_peak_conditions[] = {
    {[](const Facts& facts) { return facts.input.settings.forward_peak != ForwardPeak::automatic; },
     "render.forward_peak is \"kept\""},
    {stores_scattered_flux, by_scattered_flux},
    {limits_bounces, by_bounces},
    {[](const Facts& facts) { return facts.input.world.medium.isotropic(); },
     "phase functions are isotropic"},
    {[](const Facts& facts) { return facts.input.world.medium.colored(); },
     "a colour grid varies the albedo"},
    {has_light_that_loses_its_peak,
     "a light other than a constant sky is sampled by photons only"}};
}
const Feature forward_peak_feature{
    .name = "forward peak",
    .key = "render.forward_peak",
    .help = "multiple scattering uses delta-M truncation of the forward peak",
    .stage = Stage::photons,
    .conditions = forward_peak_conditions};

namespace {
constexpr FeatureCondition final_gather_conditions[] = {
    {gathers_along_rays, "render.estimator names another method"},
    {[](const Facts& facts) {
       return facts.input.settings.final_gather == FinalGathering::never && !is_forced(facts);
     },
     "render.final_gather is \"never\""},
    {stores_scattered_flux, by_scattered_flux},
    {limits_bounces, by_bounces},
    {has_light_that_walks_miss, "a point or directional light is sampled by photons only"},
    {has_light_that_pilots_miss,
     "a small light without shadow rays makes the pilot's noise estimate unreliable"}};
}
const Feature final_gather_feature{
    .name = "final gathering",
    .key = "render.estimator",
    .help = "photons are gathered at the end of random walks from the camera ray",
    .stage = Stage::photons,
    .conditions = final_gather_conditions,
    .used = [](const Facts&, const Choices& choices) { return choices.gather.has_value(); },
    .unused = "the pilot predicts a smaller error for gathering along camera rays, or had too few "
              "photons"};

namespace {
constexpr FeatureCondition shadow_lattice_conditions[] = {
    {shoots_no_photons, "the estimator traces no photons"},
    {[](const Facts& facts) { return facts.input.world.medium.empty(); }, "there is no medium"},
    {[](const Facts& facts) { return facts.input.world.medium.chromatic; },
     "extinction differs between channels"}};
}
const Feature shadow_lattice_feature{
    .name = "shadow lattice",
    .key = "",
    .help = "shadow rays of directional lights are placed by a coarse shadow map",
    .stage = Stage::shadow_rays,
    .conditions = shadow_lattice_conditions,
    .used =
        [](const Facts& facts, const Choices&) {
          return samples_light(facts, [](const Light& light) { return light.narrow_direction(); });
        },
    .unused = "no light has a single direction"};

namespace {
constexpr FeatureCondition boundary_share_conditions[] = {
    {stores_scattered_flux, "photons of scattered flux need no boundary correction"}};
}
const Feature boundary_share_feature{
    .name = "boundary correction",
    .key = "",
    .help = "kernel weights are divided by the fraction of the kernel inside the medium",
    .stage = Stage::photons,
    .conditions = boundary_share_conditions};

namespace {
bool has_surfaces(const Facts& facts) {
  return facts.input.world.surfaces != nullptr;
}
constexpr FeatureCondition edges_conditions[] = {
    {[](const Facts& facts) { return !facts.kind.shoots_photons(); },
     "path divides its rays among pixels by their noise"},
    {[](const Facts& facts) { return gathers_along_rays(facts) && !has_surfaces(facts); },
     "render.estimator names another method, and there are no surfaces"}};
} // namespace
const Feature edges_feature{
    .name = "refined edges",
    .key = "",
    .help = "pixels on edges of opacity, depth or light get several camera rays",
    .stage = std::nullopt, // outlines of surfaces are refined where there is no medium, too
    .conditions = edges_conditions,
    .used = [](const Facts& facts,
               const Choices& choices) { return choices.gather || has_surfaces(facts); },
    .unused = "without surfaces, only final gathering refines edges"};

namespace {
constexpr FeatureCondition branches_conditions[] = {
    {[](const Facts& facts) { return facts.kind.shoots_photons() && !has_surfaces(facts); },
     "photons carry the light; only bias probes are path traced"},
    {has_nothing_to_branch_for,
     "no phase function has a sharp enough peak, and no lamp stands in the medium"},
    {has_no_narrow_light, "no sun, lamp or spot has shadow rays"}};
}
const Feature branches_feature{
    .name = "branches",
    .key = "",
    .help = "paths, and walks from surfaces, branch towards lights of small angular size",
    .stage = std::nullopt,
    .conditions = branches_conditions};

} // namespace vdbeam
