#pragma once

#include "lights/occupied_region.h"

namespace vdbeam {

/// Samples lines that pass through the union of boxes, for photons that come from outside.
///
/// A box is chosen in proportion to its silhouette, then a line through it. A line that passes
/// through k boxes can be drawn in k ways, so its weight is divided by k and it starts where it
/// enters the first of them: overlapping boxes then count once, and no sample is rejected.
class EntrySampler {
public:
  /// Flat boxes hold no medium and are left out.
  explicit EntrySampler(const std::vector<Parallelepiped>& boxes);

  struct Entry {
    Vec3f point; ///< where the line first meets a box
    Vec3f direction;
    float weight = 0; ///< measure / density of the line; 0 where there is no box
  };

  /// A line of the given direction; the mean weight is the area of the union's silhouette.
  Entry sample_line(const Vec3f& direction, float u_face, float u, float v) const;
  /// A line of uniform radiance; the mean weight is the integral of the silhouette's area over all
  /// directions (pi times the surface area for one box), and the weight is constant but for k.
  Entry sample_surface(float u_face, float u, float v, float u_direction, float v_direction) const;

  /// Sum of the boxes' silhouettes; at least the area of the union's.
  float projected_area(const Vec3f& direction) const;
  float surface_area() const { return surface_area_; }

private:
  struct Face {
    Vec3f area; ///< outward normal times area, of the face that ends edge `index`
    int index = 0;
  };
  struct Box {
    Vec3f corner;
    std::array<Vec3f, 3> edges;
    std::array<Vec3f, 3> duals; ///< dot(duals[i], p - corner) is in [0, 1] inside
    std::array<Face, 3> faces;
  };

  Vec3f face_point(const Box& box, int axis, bool far_side, float u, float v) const;
  Entry first_entry(std::size_t chosen, const Vec3f& point, const Vec3f& direction,
                    float measure) const;

  std::vector<Box> boxes_;
  float surface_area_ = 0;
};

} // namespace vdbeam
