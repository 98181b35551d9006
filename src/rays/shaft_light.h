#pragma once

#include "medium/depth_profile.h"
#include "transport/world.h"

#include <vector>

namespace vdbeam {

/// Light that is scattered once into rays, and whether two points on each ray are lit:
/// where a ray crosses shafts of light, chance decides whether a shadow ray is lit, and that is
/// most of the noise of single scattering.
struct ShaftLight {
  float rays = 0;     ///< that were looked at
  float light = 0;    ///< sum over them of the mean [radiance], mean of channels
  float variance = 0; ///< sum over them of the variance of a point

  ShaftLight& operator+=(const ShaftLight& other) {
    rays += other.rays;
    light += other.light;
    variance += other.variance;
    return *this;
  }

  /// Factor of the shadow rays of a pixel that shows `behind` besides, by which its noise and its
  /// time balance those of the others: as the root of the relative variance.
  float effort(float behind) const;
};

/// Looks for the lights at two points drawn by what scatters along the ray. `sampled`: per light,
/// it is looked for. Uses random numbers of its own: what chooses the number of shadow rays must
/// not depend on what they find.
ShaftLight look_for_shafts(const World& world, const Ray& ray, const DepthProfile& profile,
                           const std::vector<bool>& sampled, Rng& rng);

} // namespace vdbeam
