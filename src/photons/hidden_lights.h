#pragma once

#include "rays/estimator_input.h"

#include <vector>

namespace vdbeam {

/// Of the lights that are `sampled`, those that some shadow ray reaches, of a few thousand from
/// where camera rays may be scattered: not a lamp in its bulb or behind lenses, whose light photons
/// alone bring into the medium. Without surfaces all of them.
std::vector<bool> lights_in_sight(const EstimatorInput& input, std::vector<bool> sampled);

} // namespace vdbeam
