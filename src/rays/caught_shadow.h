#pragma once

#include "transport/camera_ray.h"

namespace vdbeam {

/// The shadow on the shadow catcher at which the camera ray ends, in [0, 1]: the share of the light
/// of the world's lights, that is of lamps, sun and sky, as a diffuse surface shows it, that other
/// surfaces and the medium keep from it. Shadows that catchers cast do not count: the plate has
/// them.
///
/// An estimate by shadow rays. It is the ratio of two sums over the same samples, which is exact in
/// the mean for one light that is far away or small, and else wrong by about the relative variance
/// of a light's samples over their number.
float caught_shadow(const World& world, const CameraRay& camera, Rng& rng);

} // namespace vdbeam
