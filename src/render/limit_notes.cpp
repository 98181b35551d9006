#include "render/limit_notes.h"

#include "choose/feature.h"
#include "transport/camera_ray.h"

#include <fmt/format.h>

#include <algorithm>

namespace vdbeam {

namespace {

/// Mean free paths across the medium from which on photons are too few in the skin that is seen.
constexpr double deepest_for_photons = 5000;
/// From here on a mean free path is not much longer than single precision resolves.
constexpr double deepest_for_positions = 2e6;
/// Mean cosine of a lobe from which on few photons come from where it looks.
constexpr double narrowest_lobe = 0.98;
/// Thickness of the medium, as a share of its width, under which kernels reach through it.
constexpr double thinnest_sheet = 0.02;

double deepest(const World& world) {
  double depth = 0;
  for (const Volume& volume : world.medium.volumes)
    depth = std::max(depth, static_cast<double>(volume.extinction * volume.field.maximum()));
  return depth * 2 * static_cast<double>(world.region.radius);
}

/// Shortest by longest edge of the flattest box around something that is not empty; 1: a cube.
double flattest(const World& world) {
  float ratio = 1;
  for (const Parallelepiped& box : world.region.boxes) {
    const float a = length(box.edges[0]), b = length(box.edges[1]), c = length(box.edges[2]);
    if (const float longest = std::max({a, b, c}); longest > 0)
      ratio = std::min(ratio, std::min({a, b, c}) / longest);
  }
  return static_cast<double>(ratio);
}

/// Mean cosine of the narrowest lobe that photons have to meet. Forward peaks are none where they
/// are taken out of the medium; backward ones always stay.
double narrowest(const World& world, bool forward) {
  double narrowest = 0;
  for (const PhaseFunction& phase : world.medium.phases)
    for (int i = 0; i < phase.lobe_count(); ++i) {
      const auto g = static_cast<double>(phase.lobe(i).g);
      if ((g < 0 || forward) && std::abs(g) > std::abs(narrowest))
        narrowest = g;
    }
  return narrowest;
}

} // namespace

std::optional<std::string> starved_note(const Scene& scene, const RenderPlan& plan,
                                        const RenderStatistics& counts) {
  if (!plan.needs(Stage::photons) || !scene.surfaces.empty() || counts.lookups == 0 ||
      counts.contributions >= counts.lookups)
    return {};
  return fmt::format(
      "{} rays gathered {} photons, less than one each: scattered light is missing or concentrated "
      "in single bright pixels; increase render.radius, render.max_radius or render.photons",
      counts.lookups, counts.contributions);
}

std::vector<std::string> limit_notes(const Scene& scene, const EstimatorInput& input) {
  const World& world = input.world;
  const RenderPlan& plan = input.plan;
  std::vector<std::string> notes;
  if (scene.moments.empty() && input.world.medium.visible() &&
      !may_see_medium(input.world, input.camera)) {
    const RenderSpace& space = input.world.space;
    const Vec3d at = space.origin + Vec3d(input.world.medium.bounds.center()) / space.scale;
    notes.push_back(fmt::format("no volume is in view: they lie around [{:.3g}, {:.3g}, {:.3g}]",
                                at.x, at.y, at.z));
  }
  const double depth = deepest(world);
  if (depth > deepest_for_positions)
    notes.push_back(fmt::format("the medium is up to {:.1e} mean free paths deep: its lit surface "
                                "layer is thinner than single precision resolves",
                                depth));
  if (!plan.needs(Stage::photons))
    return notes;
  if (depth > deepest_for_photons)
    notes.push_back(fmt::format(
        "the medium is up to {:.1e} mean free paths deep: few photons lie in its visible surface "
        "layer, so parts may be dark or noisy; render.estimator = \"path\" has no such limit",
        depth));
  if (const double g =
          narrowest(world, !is_possible(forward_peak_feature,
                                        {input, estimator_kind(scene.render.estimator)}));
      std::abs(g) > narrowest_lobe)
    notes.push_back(fmt::format("a phase function of g = {:.3g} is so narrow that few photons "
                                "contribute; render.estimator = \"path\" has less noise",
                                g));
  if (const double sheet = flattest(world); sheet < thinnest_sheet)
    notes.push_back(fmt::format(
        "thin sheet, {:.2g} times as thick as it is wide: at grazing angles it renders too dark; "
        "add passes, lower render.neighbours, or use render.estimator = \"path\"",
        sheet));
  const double across = 2 * static_cast<double>(world.region.radius) / world.space.scale;
  if (scene.render.kernel == KernelRadius::fixed && scene.render.radius > 0.5 * across)
    notes.push_back(fmt::format("render.radius = {:.3g} is wide for a medium {:.3g} across: "
                                "kernels lose light outside it; use {:.3g} or less",
                                scene.render.radius, across, 0.02 * across));
  return notes;
}

} // namespace vdbeam
