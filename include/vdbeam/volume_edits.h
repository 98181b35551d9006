#pragma once

#include "vdbeam/vec.h"

#include <cstdint>
#include <optional>
#include <string>

namespace vdbeam {

/// In what a velocity grid measures lengths: the world, or the grid's index space. Automatic: the
/// world, but for files of Mantaflow, which have 2.5 voxels per second to the unit.
enum class VelocityUnits { automatic, world, index };

/// How a volume moves, for motion blur.
struct VelocitySettings {
  /// A vec3 grid, or three of floats ("vx,vy,vz"); "auto": found by its name; "none": it stands
  /// still.
  std::string grid = "auto";
  double fps = 24;  ///< frames per second: velocities are lengths per second
  double scale = 1; ///< factor of the velocities
  VelocityUnits units = VelocityUnits::automatic;
  double time = 0; ///< by which the volume is moved from the moment that its file shows [seconds]
};

/// What a grid is between its lattice points.
enum class Interpolation { linear, cubic };

/// What becomes of a grid's values v > 0: x = scale * v + offset; 0 where x < least or x <= 0,
/// otherwise curve(min(x, most) ^ power).
struct DensityRemap {
  double scale = 1;
  double offset = 0;
  double least = 0;
  std::optional<double> most;
  double power = 1;
  std::string curve = {}; ///< points "x:y x:y ...", linear in between; empty: none

  bool changes() const {
    return scale != 1 || offset != 0 || least != 0 || most || power != 1 || !curve.empty();
  }
};

/// Noise by which a volume is displaced: what is at x comes from x + amplitude n(x / size).
struct NoiseSettings {
  double amplitude = 0; ///< no point moves farther along an axis [world of the VDB]; 0: none
  double size = 1;      ///< of the noise's largest features [world of the VDB]
  int octaves = 3;      ///< each half as large and half as strong as the one before
  std::uint64_t seed = 1;
};

} // namespace vdbeam
