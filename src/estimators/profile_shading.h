#pragma once

#include "estimators/camera_ray.h"
#include "estimators/estimator.h"
#include "transport/depth_profile.h"

namespace vdbeam {

/// The parts of a pixel that follow from a depth profile alone: opacity, depth, the lights seen
/// through the medium, and emission. `surface`: radiance of the surface at which the ray ends, if
/// it does. Counts a ray in `emission_rays` where emission was integrated.
void shade_profile(const EstimatorInput& input, const CameraRay& camera,
                   const DepthProfile& profile, std::size_t pixel, PassImage& image,
                   std::uint64_t& emission_rays, const Rgb& surface = {});

/// The lights that a ray meets on `segment`, seen through the medium, whose transmittance all along
/// is `tr`. `camera`: only those that the camera sees.
Rgb lights_through(const World& world, const Segment& segment, const DepthProfile& profile,
                   const Rgb& tr, bool camera);

/// exp(-tau) all along the profile.
Rgb transmittance(const Medium& medium, const DepthProfile& profile);

} // namespace vdbeam
