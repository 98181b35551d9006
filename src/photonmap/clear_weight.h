#pragma once

#include <array>
#include <cstddef>

namespace vdbeam {

/// What a photon at `ratio` radii from a surface counts, whose kernel keeps clear of it: linear
/// between these, nothing before the first. Fitted by least squares, so that photons that lie
/// evenly before a plane are seen evenly, within 3 % from 0.1 radii on, and none of their light is
/// lost (research-log/decisions.md).
struct ClearWeight {
  float ratio, weight;
};
inline constexpr std::array<ClearWeight, 6> clear_weights{
    {{0.08f, 2.03f}, {0.12f, 0.64f}, {0.2f, 0.94f}, {0.4f, 0.99f}, {1, 1.05f}, {3, 1.03f}}};

inline float clear_weight(float ratio) {
  if (ratio < clear_weights[0].ratio)
    return 0;
  std::size_t i = 1;
  while (i + 1 < clear_weights.size() && ratio > clear_weights[i].ratio)
    ++i;
  const ClearWeight &a = clear_weights[i - 1], &b = clear_weights[i];
  return a.weight + (b.weight - a.weight) * (ratio - a.ratio) / (b.ratio - a.ratio);
}

} // namespace vdbeam
