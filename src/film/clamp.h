#pragma once

#include "image/pass_image.h"

#include <cstdint>

namespace vdbeam {

/// Light that clamping removed from passes: sums over pixels and the three channels.
struct ClampTally {
  double removed = 0;       ///< radiance that was taken away
  double total = 0;         ///< radiance before clamping
  std::uint64_t pixels = 0; ///< pixels that were dimmed, counted in each pass
};

/// Dims what the medium scatters (direct and indirect light together) in every pixel whose largest
/// channel is above `limit` [radiance] to the limit, in all channels by the same factor, and
/// returns what that removed. What is seen through the medium stays.
ClampTally clamp_pass(PassImage& pass, double limit);

} // namespace vdbeam
