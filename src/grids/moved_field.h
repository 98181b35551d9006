#pragma once

#include "vdb/vector_reader.h"
#include "volume/field_limits.h"

#include <functional>

namespace vdbeam {

/// Motion of a grid: velocities, the time that they act for [seconds], and their settings.
struct Motion {
  const VectorField& velocity;
  const VelocitySettings& settings;
};

/// The grid as its velocity carries it in settings.time: every point p goes straight to
/// p + time * v(p), taking its value along (semi-Lagrangian: the value at x is that of the p which
/// comes to x, found by a fixed point). Voxels stay what they are, on the same lattice. Throws
/// FrameError, opening with `label`, where the result would exceed the limit, and Stopped.
DensityGrid moved_grid(const DensityGrid& grid, const Motion& motion, const std::string& label,
                       const FieldLimits& limits);

/// Bounds of the ways that a velocity carries points in settings.time [world of the file].
Boxd ways_of(const Motion& motion);

/// A function that gives, for a point of the moved grid, where it was before; both in index
/// coordinates. The arguments must outlive it.
std::function<Vec3d(const Vec3d& index)> sources_of(const DensityGrid& grid, const Motion& motion);

} // namespace vdbeam
