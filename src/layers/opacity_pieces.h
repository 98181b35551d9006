#pragma once

#include "medium/depth_profile.h"
#include "medium/medium.h"

namespace vdbeam {

/// Calls add(v, share) with what volume v of the medium adds to the ray's opacity between a knot of
/// its profile and the one before, once per channel of the light: the integral of Tr sigma_t,v dt,
/// a third for each channel. Over all knots and volumes the shares add up to the opacity, mean over
/// channels.
template <class Add>
void add_opacity(const Medium& medium, const DepthProfile& profile, std::size_t knot,
                 const Add& add) {
  const Rgb before = profile.channels(medium, knot - 1), after = profile.channels(medium, knot);
  for (int c = 0; c < 3; ++c) {
    const float depth = after[c] - before[c];
    if (!(depth > 0))
      continue;
    const float added = std::exp(-before[c]) * opacity_of(depth) / (3 * depth);
    for (std::size_t v = 0; v < profile.volume_count(); ++v)
      add(profile.volume(v), added * medium.volumes[profile.volume(v)].channel_scale[c] *
                                 (profile.tau(knot, v) - profile.tau(knot - 1, v)));
  }
}

} // namespace vdbeam
