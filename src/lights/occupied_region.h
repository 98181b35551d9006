#pragma once

#include "math/ray.h"

#include <array>
#include <vector>

namespace vdbeam {

/// A parallelepiped: the corner and three edges from it.
struct Parallelepiped {
  Vec3f corner;
  std::array<Vec3f, 3> edges;
};

/// The region of the medium, at which photons are aimed: boxes in render space, which may overlap.
/// `boxes` are few and coarse (one per volume, tight around its density); `cells` are fine (one per
/// non-empty 8^3 cell or small group of them) and are used by lights of fixed direction.
struct OccupiedRegion {
  std::vector<Parallelepiped> boxes;
  std::vector<Parallelepiped> cells;
  Vec3f center; ///< of a sphere around all boxes
  float radius = 0;
};

} // namespace vdbeam
