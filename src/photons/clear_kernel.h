#pragma once

#include "photonmap/photon_map.h"

#include <array>
#include <cmath>
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

/// From this distance of a surface on, in radii, kernels are left as they are.
inline constexpr float far_from_surfaces = clear_weights.back().ratio;

/// A kernel that ends before the surface at the distance d: of radius d / sqrt(1 + (d / r)^2), less
/// than d, so that no light leaks through the surface, and no part of the kernel is cut off.
/// Photons nearer than 0.08 r, whose kernels would be too small, count as nothing; those further
/// away count so much more or less that even light stays even.
inline Kernel clear_kernel(float radius, float distance) {
  const float ratio = distance / radius;
  if (!(ratio < far_from_surfaces))
    return {radius};
  const float weight = clear_weight(ratio);
  return {weight > 0 ? distance / std::sqrt(1 + ratio * ratio) : 0, weight};
}

} // namespace vdbeam
