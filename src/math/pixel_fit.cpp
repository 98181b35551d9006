#include "math/pixel_fit.h"

#include "math/plane_fit.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

int fit_reach(float radius) {
  return radius > 0 ? static_cast<int>(std::ceil(radius)) : 0;
}

float fit_weight(float dx, float dy, float radius) {
  return std::max(0.0f, 1 - (dx * dx + dy * dy) / ((radius + 1) * (radius + 1)));
}

double fit_blur(float radius) {
  const int reach = fit_reach(radius);
  PlaneFit moments;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx)
      moments.add(
          static_cast<double>(fit_weight(static_cast<float>(dx), static_cast<float>(dy), radius)),
          dx, dy);
  const double mean_square = (moments.xx + moments.yy) / moments.one;
  return mean_square * mean_square / std::sqrt(1 + mean_square * mean_square);
}

float blur_over_difference(float radius) {
  if (!(radius > 0))
    return 0;
  return static_cast<float>(1 / (1 - std::sqrt(fit_blur(narrower_fit(radius)) / fit_blur(radius))));
}

} // namespace vdbeam
