#include "choose/pilot/gather_plan.h"

#include "choose/schedule.h"
#include "estimators/gather/regression.h"
#include "math/pixel_fit.h"
#include "tuning/constants.h"

namespace vdbeam {

namespace {

/// From each camera ray: the wider the fit, the fewer.
int walks_of(float radius) {
  return radius >= 1.4f   ? tuning::walks_of_wide_fit
         : radius >= 0.7f ? tuning::walks_of_middle_fit
                          : tuning::walks_of_narrow_fit;
}

} // namespace

double RegressionTrial::blur_of(std::size_t radius) const {
  return blur * fit_blur(radii[radius]) / fit_blur(radii.back());
}

double GatherPlan::error_after(double passes_along, std::size_t radius) const {
  const double of_most =
      walks_of(RegressionTrial::radii[radius]) / static_cast<double>(tuning::walks_of_narrow_fit);
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
  const double passes_along = tuning::time_of_gather_pass * expected_passes(pass);
  return RegressionTrial::radii[best_radius(passes_along)];
}

int GatherPlan::walks(int pass) const {
  return walks_of(regression_radius(pass));
}

} // namespace vdbeam
