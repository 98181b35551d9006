#pragma once

#include "estimators/camera_ray.h"
#include "estimators/pass_image.h"
#include "transport/depth_profile.h"

namespace vdbeam {

/// What a depth profile alone gives a pixel: opacity, depth, and the lights seen through the
/// medium.
void shade_profile(const World& world, const CameraRay& camera, const DepthProfile& profile,
                   std::size_t pixel, PassImage& image);

} // namespace vdbeam
