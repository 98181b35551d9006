#pragma once

#include "vdbeam/vec.h"
#include "vdbeam/volume_edits.h"

namespace vdbeam {

/// Gradient noise (Perlin, "Improving Noise", SIGGRAPH 2002), its gradients chosen by a hash of the
/// lattice point and the seed instead of a table, so that it never repeats. Within [-1, 1]; 0 at
/// the points of the integer lattice.
double gradient_noise(const Vec3d& point, std::uint64_t seed);

/// By how much noise displaces a point: three independent sums of octaves, within
/// settings.amplitude along each axis.
Vec3d noise_displacement(const NoiseSettings& settings, const Vec3d& point);

} // namespace vdbeam
