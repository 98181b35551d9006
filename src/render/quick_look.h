#pragma once

#include "rays/estimator_input.h"

namespace vdbeam {

/// Gives a value to every pixel of the input's window that the first pass has not finished: path
/// tracing of some pixels in an order from coarse to fine, until the input's `stop` asks to end,
/// and copies of these for the pixels around them. For something to look at, not for a film.
/// `image` is the unfinished pass, or empty; `input` has the plan of the path
/// estimator (plan_paths).
void fill_with_quick_look(const EstimatorInput& input, PassImage& image);

} // namespace vdbeam
