#include "estimators/gather/regression.h"

#include "math/pixel_fit.h"
#include "math/plane_fit.h"
#include "tuning/constants.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

PixelRegression::PixelRegression(const Camera& camera, double world_scale, float radius)
    : camera_(camera), world_scale_(world_scale), radius_(radius), reach_(fit_reach(radius)) {}

float PixelRegression::deepest(const SeenMedium& seen, int x, int y, float distance) const {
  const double pixel = camera_.pixel_width(seen.x0 + x + 0.5, seen.y0 + y + 0.5,
                                           static_cast<double>(distance) * world_scale_);
  return tuning::deepest_over_width * (radius_ + 0.5f) * static_cast<float>(pixel / world_scale_);
}

std::span<const PixelRegression::Share> PixelRegression::shares(const SeenMedium& seen, int x,
                                                                int y, Shares& shares) const {
  const auto at = [&](int px, int py) {
    return static_cast<std::size_t>(py) * static_cast<std::size_t>(seen.width) +
           static_cast<std::size_t>(px);
  };
  const std::size_t center = at(x, y);
  const float opacity = seen.opacity[center];
  shares[0] = {center, 1};
  if (reach_ == 0 || !(opacity > 0))
    return {shares.data(), 1};
  const float distance = seen.depth[center] / opacity;
  const float deepest = this->deepest(seen, x, y, distance);
  if (!(deepest > 0)) // a medium at the lens itself
    return {shares.data(), 1};
  std::array<std::array<double, 2>, most_shares> offsets;
  PlaneFit moments;
  std::size_t count = 0;
  for (int py = std::max(0, y - reach_); py <= std::min(seen.height - 1, y + reach_); ++py)
    for (int px = std::max(0, x - reach_); px <= std::min(seen.width - 1, x + reach_); ++px) {
      const std::size_t pixel = at(px, py);
      const float own = seen.opacity[pixel];
      if (!(own > 0))
        continue;
      const auto dx = static_cast<float>(px - x), dy = static_cast<float>(py - y);
      const float off = (seen.depth[pixel] / own - distance) / deepest;
      const float weight = fit_weight(dx, dy, radius_) * std::max(0.0f, 1 - off * off);
      if (!(weight > 0))
        continue;
      // The variance of light per opacity goes as one over the opacity.
      moments.add(static_cast<double>(weight * own), px - x, py - y);
      offsets[count] = {static_cast<double>(px - x), static_cast<double>(py - y)};
      shares[count++] = {pixel, weight};
    }
  const std::array<double, 3> row = moments.row();
  for (std::size_t i = 0; i < count; ++i)
    shares[i].weight *=
        opacity * static_cast<float>(row[0] + row[1] * offsets[i][0] + row[2] * offsets[i][1]);
  return {shares.data(), count};
}

} // namespace vdbeam
