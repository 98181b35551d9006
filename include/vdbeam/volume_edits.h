#pragma once

#include "vdbeam/vec.h"

#include <cstdint>
#include <optional>
#include <string>

namespace vdbeam {

/// Unit of length of a velocity grid: the world, or the grid's index space. Automatic: the world,
/// except for files of Mantaflow, whose unit is 2.5 voxels per second.
enum class VelocityUnits { automatic, world, index };

/// Velocity of a volume, for motion blur.
struct VelocitySettings {
  /// A vec3 grid, or three of floats ("vx,vy,vz"); "auto": found by its name; "none": it stands
  /// still.
  std::string grid = "auto";
  double fps = 24;  ///< frames per second: velocities are lengths per second
  double scale = 1; ///< factor of the velocities
  VelocityUnits units = VelocityUnits::automatic;
  double time = 0; ///< time of the motion sample after the moment of the file [seconds]
};

/// Interpolation of a grid between its lattice points.
enum class Interpolation { linear, cubic };

/// Remapping of a grid's values v > 0: x = scale * v + offset; 0 where x < least or x <= 0,
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

/// Displacement of a volume by noise: the value at x is taken from x + amplitude n(x / size).
struct NoiseSettings {
  double amplitude = 0; ///< greatest displacement along an axis [world of the VDB]; 0: none
  double size = 1;      ///< size of the largest features [world of the VDB]
  int octaves = 3;      ///< each half as large and half as strong as the one before
  std::uint64_t seed = 1;
};

} // namespace vdbeam
