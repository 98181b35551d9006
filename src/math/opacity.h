#pragma once

#include "vdbeam/vec.h"

#include <cmath>

namespace vdbeam {

/// 1 - exp(-tau), the share of the light that a medium of optical depth `tau` takes, to a relative
/// error of 5e-7. Requires tau >= 0. Faster than std::expm1, which took a twelfth of a render.
inline float opacity_of(float tau) {
  if (tau < 0.25f) // the series, since a difference of nearly equal numbers has no digits left
    return tau * (1 - tau * (1.0f / 2) *
                          (1 - tau * (1.0f / 3) *
                                   (1 - tau * (1.0f / 4) *
                                            (1 - tau * (1.0f / 5) * (1 - tau * (1.0f / 6))))));
  return 1 - std::exp(-tau);
}

/// exp(-tau) of each channel.
inline Rgb transmittance_of(const Rgb& tau) {
  return {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
}

} // namespace vdbeam
