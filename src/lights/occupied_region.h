#pragma once

#include "math/affine.h"
#include "math/ray.h"

#include <array>
#include <vector>

namespace vdbeam {

/// A parallelepiped: the corner and three edges from it.
struct Parallelepiped {
  Vec3f corner;
  std::array<Vec3f, 3> edges;

  double surface_area() const {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      sum += 2 * static_cast<double>(length(cross(edges[i], edges[(i + 1) % 3])));
    return sum;
  }
  Boxd bounds() const {
    Boxd result;
    for (int i = 0; i < 8; ++i) {
      Vec3f point = corner;
      for (int edge = 0; edge < 3; ++edge)
        if (i >> edge & 1)
          point += edges[static_cast<std::size_t>(edge)];
      result.extend(Vec3d(point));
    }
    return result;
  }
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
