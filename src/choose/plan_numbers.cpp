#include "choose/plan_numbers.h"

#include "choose/pilot/kernel_pilot.h"
#include "tuning/constants.h"

#include <fmt/format.h>

#include <algorithm>

namespace vdbeam {

namespace {

/// How a number was found.
struct Origin {
  NumberOrigin from;
  std::string reason;
};

class NumberList {
public:
  NumberList(const EstimatorInput& input, const Choices& choices,
             const std::vector<PassSpec>& schedule)
      : input_(input), settings_(input.settings), choices_(choices), plan_(choices.photons),
        schedule_(schedule) {}

  std::vector<PlanNumber> list() {
    const bool photons = input_.plan.needs(Stage::photons);
    if (photons || input_.plan.needs(Stage::surface_photons))
      add("light paths", "render.photons", static_cast<double>(plan_.paths), origin_of_paths());
    if (photons)
      add_kernels();
    if (choices_.gather)
      add_gathering();
    if (choices_.fits_surfaces)
      add_fit("fit on surfaces [pixels]", &PassSpec::surface_fit_radius,
              {NumberOrigin::standard, "shrinks, so that its blur vanishes as noise does"});
    if (input_.plan.needs(Stage::shadow_rays) && !plan_.sampled_lights.empty())
      numbers_.push_back({"shadow rays per camera ray", "render.direct_samples",
                          static_cast<double>(plan_.direct_samples),
                          static_cast<double>(plan_.most_direct_samples),
                          origin_of_shadow_rays().from, origin_of_shadow_rays().reason});
    return std::move(numbers_);
  }

private:
  void add(std::string_view name, std::string_view key, double value, const Origin& origin) {
    numbers_.push_back({name, key, value, value, origin.from, origin.reason});
  }
  void add_fit(std::string_view name, float PassSpec::*radius, const Origin& origin) {
    numbers_.push_back({name, "", static_cast<double>(schedule_.front().*radius),
                        static_cast<double>(schedule_.back().*radius), origin.from, origin.reason});
  }

  void add_kernels() {
    if (settings_.kernel == KernelRadius::fixed)
      add("kernel radius [world]", "render.radius", settings_.radius,
          {NumberOrigin::scene, "of the first pass"});
    else
      add("neighbours", "render.neighbours", schedule_.front().neighbours, origin_of_neighbours());
    const bool given = settings_.alpha != RenderSettings().alpha;
    numbers_.push_back({"kernel scale", "render.alpha", 1,
                        static_cast<double>(schedule_.back().kernel_scale),
                        given ? NumberOrigin::scene : NumberOrigin::standard,
                        fmt::format("kernels shrink by render.alpha = {:g}", settings_.alpha)});
    if (!choices_.peak.taken_out)
      return;
    const auto [least, most] = std::minmax_element(
        schedule_.begin(), schedule_.end(),
        [](const PassSpec& a, const PassSpec& b) { return a.peak_order < b.peak_order; });
    numbers_.push_back(
        {"peak order", "render.forward_peak", static_cast<double>(least->peak_order),
         static_cast<double>(most->peak_order), NumberOrigin::measured,
         "follows the phase functions and the depth of the medium, and grows with the passes"});
  }

  void add_gathering() {
    const bool tried = choices_.gather->noise > 0;
    const Origin origin{tried ? NumberOrigin::measured : NumberOrigin::standard,
                        tried ? fmt::format("noise of walks against blur, in a pilot of {} pixels",
                                            choices_.trial->pixels.size())
                              : "no pilot measured the noise of walks"};
    numbers_.push_back(
        {"walks per camera ray", "", static_cast<double>(schedule_.front().gather_walks),
         static_cast<double>(schedule_.back().gather_walks), origin.from, "wider fits need fewer"});
    add_fit("fit [pixels]", &PassSpec::regression_radius, origin);
  }

  Origin origin_of_paths() const {
    if (settings_.photons)
      return {NumberOrigin::scene, fmt::format("for render.photons = {}, at {:.2g} stored per path",
                                               *settings_.photons, plan_.stored_per_path)};
    const auto paths = static_cast<double>(plan_.paths);
    if (paths <= tuning::fewest_paths)
      return {NumberOrigin::standard,
              fmt::format("the fewest of a pass; {:.0f} camera rays show light of photons",
                          plan_.hits)};
    return {NumberOrigin::measured,
            fmt::format("{:.2g} for each of {:.0f} camera rays that show light of photons",
                        paths / plan_.hits, plan_.hits)};
  }

  Origin origin_of_neighbours() const {
    if (settings_.neighbours > 0)
      return {NumberOrigin::scene, "photons in a kernel"};
    const std::string part = choices_.gather ? fmt::format("; walks gather {:g} times that",
                                                           tuning::neighbours_of_gather)
                                             : std::string();
    if (!choices_.trial)
      return {NumberOrigin::standard,
              fmt::format("{:.0f}, since no pilot ran{}", plan_.neighbours, part)};
    return {NumberOrigin::measured,
            fmt::format("{} small photon maps had the least noise and blur with {:.0f}{}",
                        2 * tuning::trial_maps, plan_.neighbours, part)};
  }

  Origin origin_of_shadow_rays() const {
    if (settings_.direct_samples > 0)
      return {NumberOrigin::scene, "sets of one for each light"};
    if (!input_.plan.needs(Stage::photons))
      return {NumberOrigin::standard, "sets of one for each light; no light paths were traced"};
    return {NumberOrigin::measured,
            fmt::format("sets of one for each light, by the {:.2g} collisions of a light path",
                        plan_.collisions_per_path)};
  }

  const EstimatorInput& input_;
  const RenderSettings& settings_;
  const Choices& choices_;
  const PhotonPlan& plan_;
  const std::vector<PassSpec>& schedule_;
  std::vector<PlanNumber> numbers_;
};

} // namespace

std::vector<PlanNumber> describe_numbers(const EstimatorInput& input, const Choices& choices,
                                         const std::vector<PassSpec>& schedule) {
  return NumberList(input, choices, schedule).list();
}

} // namespace vdbeam
