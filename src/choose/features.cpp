#include "choose/feature.h"
#include "choose/names.h"
#include "choose/schedule.h"
#include "phase/truncated_phase.h"
#include "walks/light_branches.h"

#include <fmt/format.h>

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
bool gathers_along_rays(const Facts& facts) {
  return !facts.kind.may_gather();
}

/// A question about a light of the world.
using LightTest = bool (*)(const Facts& facts, std::size_t light);

template <LightTest test>
bool any_light(const Facts& facts) {
  for (std::size_t i = 0; i < facts.input.world.lights.size(); ++i)
    if (test(facts, i))
      return true;
  return false;
}
template <LightTest test>
std::string lights_that(const Facts& facts) {
  return light_names(facts.input.world, [&](std::size_t light) { return test(facts, light); });
}

/// Removing the peak is valid only if every light has shadow rays or is a constant sky; otherwise
/// light that is scattered by the peak alone is lost.
bool loses_its_peak(const Facts& facts, std::size_t light) {
  const LightTraits& traits = facts.input.world.lights.traits(light);
  return !facts.sampled_lights[light] && !traits.is_emission &&
         (!traits.surrounds || traits.wants_shadow_rays);
}

/// Walks meet no light that has but one point or direction.
bool is_missed_by_walks(const Facts& facts, std::size_t light) {
  return !facts.sampled_lights[light] && facts.input.world.lights[light].is_delta();
}

/// A small light without shadow rays is met by chance only: rare and bright values, which a pilot
/// would miss.
bool is_missed_by_pilots(const Facts& facts, std::size_t light) {
  if (facts.kind.gathers() || light >= facts.input.plan.shadow_ray_lights.size())
    return false;
  const LightTraits& traits = facts.input.world.lights.traits(light);
  return !facts.sampled_lights[light] && (!traits.surrounds || traits.wants_shadow_rays);
}

bool has_surfaces(const Facts& facts) {
  return facts.input.world.surfaces != nullptr;
}

/// "photons on surfaces", as `text` says, where there are any.
std::string where_photons_lie_on_surfaces(const Facts& facts, std::string_view text) {
  return facts.needs(Stage::surface_photons) ? std::string(text) : std::string();
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

const Feature view_importance_feature{
    .name = "view importance",
    .key = "render.thinning",
    .help = "photons are stored by their importance for the camera",
    .stage = Stage::photon_importance,
    .conditions = {},
    .rest =
        [](const Facts& facts, const Choices&) {
          return where_photons_lie_on_surfaces(facts, "photons on surfaces");
        },
    .cost = [](const Facts& facts,
               const Choices& choices) { return work_text(facts, choices, choices.view_work); }};

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
    .unused = "the pilot stored too few photons to estimate importance",
    .whole = "all light paths",
    .cost = [](const Facts& facts,
               const Choices& choices) { return work_text(facts, choices, choices.guide_work); }};

const Feature kernel_pilot_feature{
    .name = "kernel pilot",
    .key = "render.neighbours",
    .help = "the kernel width balances noise and bias, measured on small photon maps",
    .stage = Stage::kernel_pilot,
    .conditions = {},
    .used = [](const Facts&, const Choices& choices) { return choices.trial != nullptr; },
    .unused = "there are too few photons for a pilot",
    .whole = "all kernels",
    .rest =
        [](const Facts& facts, const Choices&) {
          return where_photons_lie_on_surfaces(facts, "kernels of photons on surfaces");
        },
    .cost = [](const Facts& facts,
               const Choices& choices) { return work_text(facts, choices, choices.kernel_work); }};

namespace {
constexpr FeatureCondition forward_peak_conditions[] = {
    {[](const Facts& facts) { return facts.input.settings.forward_peak != ForwardPeak::automatic; },
     "render.forward_peak is \"kept\""},
    {stores_scattered_flux, by_scattered_flux},
    {limits_bounces, by_bounces},
    {[](const Facts& facts) { return facts.input.world.medium.isotropic(); },
     "phase functions are isotropic"},
    {[](const Facts& facts) { return facts.input.world.medium.colored(); },
     "a colour grid varies the albedo",
     [](const Facts& facts) {
       return volume_names(facts.input.world,
                           [](const Volume& volume) { return volume.color != nullptr; });
     }},
    {any_light<loses_its_peak>, "a light other than a constant sky is sampled by photons only",
     lights_that<loses_its_peak>}};

/// Volumes whose phase functions have no peak at the order of the first pass.
std::string volumes_without_peak(const Facts& facts, const Choices& choices) {
  const World& world = facts.input.world;
  const int order = peak_order(choices.peak, 0, choices.gather.has_value());
  return volume_names(world, [&](const Volume& volume) {
    return order == 0 ||
           truncate_peak(world.medium.phases[static_cast<std::size_t>(volume.phase_index)], order)
                   .forward == 0;
  });
}
} // namespace
const Feature forward_peak_feature{
    .name = "forward peak",
    .key = "render.forward_peak",
    .help = "multiple scattering uses delta-M truncation of the forward peak",
    .stage = Stage::photons,
    .conditions = forward_peak_conditions,
    .used = [](const Facts&, const Choices& choices) { return choices.peak.taken_out; },
    .unused = "no phase function has a peak that is worth truncating",
    .rest = volumes_without_peak};

namespace {
constexpr FeatureCondition final_gather_conditions[] = {
    {gathers_along_rays, "render.estimator names another method"},
    {stores_scattered_flux, by_scattered_flux},
    {limits_bounces, by_bounces},
    {any_light<is_missed_by_walks>, "a point or directional light is sampled by photons only",
     lights_that<is_missed_by_walks>},
    {any_light<is_missed_by_pilots>,
     "a small light without shadow rays makes the pilot's noise estimate unreliable",
     lights_that<is_missed_by_pilots>}};

/// Light for which photons are gathered along camera rays all the same.
std::string gathered_along_rays(const Facts& facts, const Choices&) {
  const World& world = facts.input.world;
  if (!world.surfaces || !world.surfaces->focus_light())
    return {};
  const std::vector<bool> caustic = caustic_lights(world);
  const std::string lights = light_names(world, [&](std::size_t i) { return caustic[i]; });
  return lights.empty() ? "rays behind mirrors and glass"
                        : "rays behind mirrors and glass, and caustics of " + lights;
}

/// The forecast against gathering along camera rays, whichever is used.
std::string cost_of_gather(const Facts&, const Choices& choices) {
  const double lead = choices.lead_of_gather;
  if (!(lead > 0))
    return {};
  if (choices.gather)
    return fmt::format("at equal time, gathering along camera rays has {:.2g} times its forecast "
                       "error",
                       lead);
  return fmt::format("at equal time it has {:.2g} times the forecast error", 1 / lead);
}
} // namespace
const Feature final_gather_feature{
    .name = "final gathering",
    .key = "render.estimator",
    .help = "photons are gathered at the end of random walks from the camera ray",
    .stage = Stage::photons,
    .conditions = final_gather_conditions,
    .used = [](const Facts&, const Choices& choices) { return choices.gather.has_value(); },
    .unused = "the pilot predicts a smaller error for gathering along camera rays, or had too few "
              "photons",
    .rest = gathered_along_rays,
    .cost = cost_of_gather};

namespace {
/// Lights for which shadow rays are planned: those in sight, or those that are hidden.
std::string planned_lights(const Facts& facts, const Choices& choices, bool in_sight) {
  const std::vector<bool> all = facts.input.shadow_ray_lights(),
                          &seen = choices.photons.sampled_lights;
  return light_names(facts.input.world, [&](std::size_t i) {
    return i < seen.size() && all[i] && seen[i] == in_sight;
  });
}
constexpr FeatureCondition hidden_lights_conditions[] = {
    {shoots_no_photons, "the estimator traces no photons"},
    {[](const Facts& facts) { return !has_surfaces(facts); }, "no surface hides a light"}};
} // namespace
const Feature hidden_lights_feature{
    .name = "hidden lights",
    .key = "",
    .help = "lights that surfaces hide from all that the camera sees get no shadow rays",
    .stage = Stage::shadow_rays,
    .conditions = hidden_lights_conditions,
    .used = [](const Facts& facts,
               const Choices& choices) { return !planned_lights(facts, choices, false).empty(); },
    .unused = "no light is hidden, or final gathering looks for all of them",
    .whole = "all lights",
    .rest = [](const Facts& facts,
               const Choices& choices) { return planned_lights(facts, choices, true); }};

namespace {
constexpr FeatureCondition shadow_lattice_conditions[] = {
    {shoots_no_photons, "the estimator traces no photons"},
    {[](const Facts& facts) { return facts.input.world.medium.empty(); }, "there is no medium"},
    {[](const Facts& facts) { return facts.input.world.medium.chromatic; },
     "extinction differs between channels",
     [](const Facts& facts) {
       return volume_names(facts.input.world, [](const Volume& volume) {
         const Rgb& scale = volume.channel_scale;
         return scale.x != scale.y || scale.y != scale.z;
       });
     }}};
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
    .unused = "no light has a single direction",
    .whole = "all shadow rays",
    .rest =
        [](const Facts& facts, const Choices&) {
          const LightSet& lights = facts.input.world.lights;
          const std::string names = light_names(facts.input.world, [&](std::size_t i) {
            return facts.sampled_lights[i] && !lights[i].narrow_direction();
          });
          return names.empty() ? names : "shadow rays to " + names;
        }};

namespace {
constexpr FeatureCondition boundary_share_conditions[] = {
    {stores_scattered_flux, "photons of scattered flux need no boundary correction"}};
}
const Feature boundary_share_feature{
    .name = "boundary correction",
    .key = "",
    .help = "kernel weights are divided by the fraction of the kernel inside the medium",
    .stage = Stage::photons,
    .conditions = boundary_share_conditions,
    .whole = "all kernels"};

namespace {
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
    .unused = "without surfaces, only final gathering refines edges",
    .whole = "all pixels",
    .rest =
        [](const Facts&, const Choices& choices) {
          return choices.gather ? std::string() : "edges of the medium";
        }};

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
    .conditions = branches_conditions,
    .whole = "all paths and walks",
    .rest = [](const Facts& facts, const Choices&) {
      const LightSet& lights = facts.input.world.lights;
      const std::string names = light_names(facts.input.world, [&](std::size_t i) {
        return facts.sampled_lights[i] && !LightBranches::is_narrow(lights[i]);
      });
      return names.empty() ? names : "paths to " + names;
    }};

} // namespace vdbeam
