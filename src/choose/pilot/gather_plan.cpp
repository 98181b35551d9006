#include "choose/pilot/gather_plan.h"

#include "choose/schedule.h"
#include "estimators/gather/regression.h"
#include "math/pixel_fit.h"
#include "tuning/constants.h"

namespace vdbeam {

namespace {

/// From each camera ray: the wider the fit, the fewer.
int walks_of(float radius) {
  return radius >= 1.4f ? 6 : radius >= 0.7f ? 8 : GatherPlan::most_walks;
}

} // namespace

double RegressionTrial::blur_of(std::size_t radius) const {
  return blur * fit_blur(radii[radius]) / fit_blur(radii.back());
}

double GatherPlan::error_after(double passes_along, std::size_t radius) const {
  const double of_most = walks_of(RegressionTrial::radii[radius]) / static_cast<double>(most_walks);
  const double passes = passes_along / (1 + tuning::time_of_walks * of_most);
  return (photons_noise + noise / of_most * regression.noise[radius]) / passes +
         regression.blur_of(radius);
}

std::size_t GatherPlan::best_radius(double passes_along) const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < RegressionTrial::radii.size(); ++i)
    if (error_after(passes_along, i) < error_after(passes_along, best))
      best = i;
  return best;
}

double GatherPlan::error_after(double passes_along) const {
  return error_after(passes_along, best_radius(passes_along));
}

float GatherPlan::regression_radius(int pass) const {
  constexpr double time_of_pass = 1.5; // of walks, in passes of beam
  return RegressionTrial::radii[best_radius(time_of_pass * expected_passes(pass))];
}

int GatherPlan::walks(int pass) const {
  return walks_of(regression_radius(pass));
}

} // namespace vdbeam
