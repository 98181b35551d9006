#pragma once

#include "transport/camera_ray.h"

namespace vdbeam {

struct CaughtShadow {
  float mean = 0;    ///< share of the light, over all channels, that is kept away, in [0, 1]
  Rgb left = Rgb(1); ///< per channel, the share of the light that arrives, in [0, 1]
};

/// Returns the shadow on the shadow catcher at which the camera ray ends: what other surfaces and
/// the medium keep from it of the light of the plate's lights, as a diffuse surface shows it.
/// Shadows that catchers cast do not count: the plate has them.
///
/// An estimate by shadow rays. Of each light it is the ratio of two sums over the same samples,
/// which is exact in the mean for a light that is far away or small, and else wrong by about the
/// relative variance of the light's samples over their number; lights are weighed by many more
/// samples than have shadow rays.
CaughtShadow caught_shadow(const World& world, const CameraRay& camera, Rng& rng);

} // namespace vdbeam
