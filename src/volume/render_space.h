#pragma once

#include "math/affine.h"

namespace vdbeam {

/// Where all single-precision work happens: the world moved so that the occupied bounds are centred
/// at 0 and scaled by a power of two to a size near 1. Volumes far from the origin, or of extreme
/// size, then cost no precision. Radiance is the same in both spaces; lengths and distances scale
/// by `scale`, areas by its square.
struct RenderSpace {
  Vec3d origin;     ///< world position of render-space 0
  double scale = 1; ///< render units per world unit

  Vec3d point(const Vec3d& world) const { return (world - origin) * scale; }
  /// The affine map world -> render.
  Affine map() const {
    Affine m;
    m.rows = {Vec3d{scale, 0, 0}, Vec3d{0, scale, 0}, Vec3d{0, 0, scale}};
    m.translation = origin * -scale;
    return m;
  }
};

} // namespace vdbeam
