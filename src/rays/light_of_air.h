#pragma once

#include "rays/estimator_input.h"
#include "transport/camera_ray.h"

namespace vdbeam {

/// Adds the light that the air scatters between the camera and the medium to the direct light of
/// the pixel, as far as the medium hides what is behind: the integral of I(t) Tr(t) sigma_t(t) dt,
/// I(t) being the light of the air up to the distance t. So the medium's layers can be composited
/// over others that have air of their own. `profile` belongs to the world of the input.
void add_light_of_air(const EstimatorInput& input, const CameraRay& camera,
                      const DepthProfile& profile, std::size_t pixel, PassImage& image);

} // namespace vdbeam
