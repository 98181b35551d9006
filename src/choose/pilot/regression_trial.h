#pragma once

#include "choose/pilot/gather_plan.h"
#include "choose/pilot/trial_tile.h"

namespace vdbeam {

/// Effect of regression over pixels on the tiles' gathers in narrow kernels, and from that
/// to what walks find. `dark`: of the weights (trial_weight).
RegressionTrial measure_regression(const EstimatorInput& input, const std::vector<TrialTile>& tiles,
                                   double dark);

} // namespace vdbeam
