#pragma once

#include "image/deep_layout.h"
#include "rays/estimator_input.h"

#include <functional>

namespace vdbeam {

/// Cuts the rays of every pixel of the input's window: a piece adds at most `alpha` to the opacity,
/// as the mean of a few rays of the pixel has it, and is at most `depth` [world] long; emptiness
/// between two parts of the medium is a piece of its own. A pure function of world, camera and
/// seed, so that passes that are rendered apart can be merged. `window`: empty for the whole
/// picture. `check` is called from several threads with the number of pieces so far, and may throw
/// to end the work.
DeepLayout make_deep_layout(const EstimatorInput& input, double alpha, double depth,
                            const std::function<void(std::size_t pieces)>& check);

/// The layout for the window alone, whose pixels are those that have pieces.
DeepLayout cut_out(const DeepLayout& layout, int width, const PixelRegion& window);

} // namespace vdbeam
