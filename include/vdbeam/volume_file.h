#pragma once

#include "vdbeam/vec.h"

#include <string>

namespace vdbeam {

/// Densities at the points of a regular lattice, z fastest:
/// values[(x * size.y + y) * size.z + z].
struct DensityArray {
  const float* values = nullptr; ///< not owned
  Vec3<int> size{0, 0, 0};       ///< points along each axis
  double voxel_size = 1;         ///< between points [world]
  Vec3d origin{0, 0, 0};         ///< of point (0, 0, 0) [world]
};

/// Writes the array as a float grid of a VDB file, which is never half there; zeros take no room.
/// Throws InputError for a size or voxel size that is not positive, FrameError where the file
/// cannot be written.
void write_volume_file(const DensityArray& density, const std::string& path,
                       const std::string& grid = "density");

} // namespace vdbeam
