#pragma once

#include "rays/estimator_input.h"

#include <vector>

namespace vdbeam {

/// The `sampled` lights that at least one of a few thousand shadow rays from points on camera rays
/// reaches. A lamp in a bulb or behind lenses is not among them; its light comes from photons only.
/// Without surfaces, all of them.
std::vector<bool> lights_in_sight(const EstimatorInput& input, std::vector<bool> sampled);

} // namespace vdbeam
