#pragma once

#include "photonmap/beam_tile.h"

#include <algorithm>

namespace vdbeam {

/// Bounds of some rays of a tile in its frame, linear in the depth w: a0 w + u0 <= u <= a1 w + u1,
/// and the same for v. For rays from one point the slopes are tangents and u0 .. v1 are 0.
struct RayBounds {
  double a0 = 1e30, a1 = -1e30, b0 = 1e30, b1 = -1e30;
  double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
  double cos0 = 1, cos1 = 0;     ///< least and greatest dw
  double start0 = 0, start1 = 0; ///< least and greatest depth at which a ray starts
  bool wide = false; ///< some ray is nearly square to the axis: no bound but those of depths

  /// Extends the bounds, for rays that start at one point.
  void extend(const RayBounds& box) {
    a0 = std::min(a0, box.a0);
    a1 = std::max(a1, box.a1);
    b0 = std::min(b0, box.b0);
    b1 = std::max(b1, box.b1);
    cos0 = std::min(cos0, box.cos0);
    cos1 = std::max(cos1, box.cos1);
    wide = wide || box.wide;
  }
};

inline Vec3d ray_direction(const BeamTile& tile, int ray) {
  return {tile.du[ray], tile.dv[ray], tile.dw[ray]};
}

/// Where a ray starts, from the rays' common origin.
inline Vec3d ray_start(const BeamTile& tile, int ray) {
  return {tile.ou[ray], tile.ov[ray], tile.ow[ray]};
}

/// Rays of a tile's unused part may be left without a direction.
inline bool is_live(const Vec3d& d) {
  const double square = dot(d, d);
  return square > 0.25 && square < 4;
}

/// Tangents and cosines of rays that start at one point; of others the cosines and starts alone.
RayBounds bound_directions(const BeamTile& tile, int first_ray, int rays);

/// Fills the linear bounds of rays with origins of their own, which hold for depths in [w0, w1].
void bound_between(const BeamTile& tile, int first_ray, int rays, double w0, double w1,
                   RayBounds& bounds);

} // namespace vdbeam
