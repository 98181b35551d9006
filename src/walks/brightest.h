#pragma once

#include "tuning/constants.h"
#include "vdbeam/vec.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace vdbeam {

/// The number of lights that are looked at if there are `all`: all of a few,
/// tuning::lamps_per_vertex of many.
inline std::size_t brightest_count(std::size_t all) {
  const auto count = static_cast<std::size_t>(tuning::lamps_per_vertex);
  return all <= 2 * count ? all : count;
}

/// The irradiance from a lamp at the end of the vector `to_lamp`; no NaN even if that is 0.
inline double irradiance_from(double intensity, const Vec3d& to_lamp) {
  return intensity / std::max(dot(to_lamp, to_lamp), std::numeric_limits<double>::min());
}

/// Puts to `brightest` those of the lights that have the largest key(light), brightest_count() of
/// them, always in the same order. Looking at a few of hundreds keeps their cost low.
template <class Light, class Key>
void find_brightest(const std::vector<Light>& lights, const Key& key,
                    std::vector<const Light*>& brightest) {
  brightest.clear();
  const std::size_t count = brightest_count(lights.size());
  if (lights.size() == count) {
    for (const Light& light : lights)
      brightest.push_back(&light);
    return;
  }
  std::vector<std::pair<double, const Light*>> ranked;
  ranked.reserve(lights.size());
  for (const Light& light : lights)
    ranked.push_back({key(light), &light});
  const auto end = ranked.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(ranked.begin(), end, ranked.end(),
                   [](const auto& a, const auto& b) { return a > b; });
  std::for_each(ranked.begin(), end, [&](const auto& one) { brightest.push_back(one.second); });
}

} // namespace vdbeam
