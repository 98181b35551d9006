#pragma once

#include "math/ray.h"
#include "vdbeam/scene.h"

namespace vdbeam {

/// Normalised disc kernels of radius r as functions of s = d^2 / r^2 in [0, 1); multiply by 1 /
/// r^2. Each integrates to 1 over the disc: integral_0^1 k(s) pi ds = 1.
inline float disc_kernel(KernelShape shape, float s) {
  switch (shape) {
  case KernelShape::constant:
    return 1 / pi;
  case KernelShape::epanechnikov:
    return 2 / pi * (1 - s);
  case KernelShape::biweight:
    return 3 / pi * (1 - s) * (1 - s);
  case KernelShape::fourth_order:
    return 6 / pi * (1 - s) * (1 - 2 * s);
  }
  return 0;
}

/// Normalised ball kernels of radius r as functions of s = d^2 / r^2; multiply by 1 / r^3.
/// Each integrates to 1 over the ball: integral_0^1 k(s) 2 pi sqrt(s) ds = 1.
inline float ball_kernel(KernelShape shape, float s) {
  switch (shape) {
  case KernelShape::constant:
    return 3 / (4 * pi);
  case KernelShape::epanechnikov:
    return 15 / (8 * pi) * (1 - s);
  case KernelShape::biweight:
    return 105 / (32 * pi) * (1 - s) * (1 - s);
  case KernelShape::fourth_order: // (1 - s)(1 - b s): b = 9/5 makes the second moment 0
    return 525 / (64 * pi) * (1 - s) * (1 - 1.8f * s);
  }
  return 0;
}

} // namespace vdbeam
