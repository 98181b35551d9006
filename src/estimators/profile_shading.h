#pragma once

#include "estimators/camera_ray.h"
#include "image/pass_image.h"
#include "transport/depth_profile.h"

namespace vdbeam {

/// What a depth profile alone gives a pixel: opacity, depth, the lights seen through the medium,
/// and the medium's own light. Adds to `emission_rays` where that was looked for.
void shade_profile(const World& world, const CameraRay& camera, const DepthProfile& profile,
                   std::size_t pixel, PassImage& image, std::uint64_t& emission_rays);

} // namespace vdbeam
