#pragma once

#include "lights/occupied_region.h"

#include <cstdint>

namespace vdbeam {

/// The occupied region as seen from a light of (nearly) fixed direction: a raster on the plane
/// through the region's centre, perpendicular to the light, that covers the projection of every
/// cell. Lines through its pixels cover all of the medium and little else.
class SilhouetteMask {
public:
  /// `axis` (unit): the way the light travels. `tan_spread`: lines may deviate from the axis by
  /// this tangent and still hit no cell that the mask does not cover.
  SilhouetteMask(const Vec3f& axis, float tan_spread, const OccupiedRegion& region);

  struct Point {
    Vec3f position;  ///< on the plane
    float depth = 0; ///< along the axis, from the plane to before the nearest cell; may be negative
  };
  /// Uniform over the mask. Requires area() > 0. `pixel` is uniform over 32 bits.
  Point sample(std::uint32_t pixel, float u, float v) const;

  /// Covered area; 0 where the region is empty.
  float area() const { return area_; }

private:
  struct Pixel {
    std::uint16_t x, y;
    float depth;
  };

  std::vector<Pixel> pixels_;
  Vec3d corner_, step_x_, step_y_;
  float area_ = 0;
};

} // namespace vdbeam
