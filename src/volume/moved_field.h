#pragma once

#include "volume/velocity_field.h"

namespace vdbeam {

/// What moves a grid: velocities, the time that they act for [seconds], and their settings.
struct Motion {
  const VelocityField& velocity;
  const VelocitySettings& settings;
};

/// The grid as its velocity carries it in settings.time: every point p goes straight to
/// p + time * v(p), taking its value along (semi-Lagrangian: the value at x is that of the p which
/// comes to x, found by a fixed point). Voxels stay what they are, on the same lattice. Throws
/// FrameError, opening with `label`, where the result would exceed `maximum_bytes`.
DensityGrid moved_grid(const DensityGrid& grid, const Motion& motion, const std::string& label,
                       std::uint64_t maximum_bytes);

} // namespace vdbeam
