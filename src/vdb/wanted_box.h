#pragma once

#include "math/affine.h"

#include <cstdint>

namespace vdbeam {

/// The part of a grid that is needed: what lies in a box of the file's world, and as much around it
/// as interpolation reaches.
struct WantedBox {
  Boxd world;

  struct Voxels {
    Vec3<std::int64_t> lower, upper; ///< both included
  };
  /// Voxels that hold it, whole leaves of 8^3; the box of a turned grid is longer and wider.
  Voxels voxels(const Affine& index_to_world) const;
};

} // namespace vdbeam
