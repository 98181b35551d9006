#pragma once

#include "estimators/pilot/trial_tile.h"
#include "photons/walk_plan.h"

namespace vdbeam {

/// What sharing with the pixels around would do to what the tiles gather in narrow kernels, and
/// from that to what walks find. `dark`: of the weights (trial_weight).
SharingTrial measure_sharing(const EstimatorInput& input, const std::vector<TrialTile>& tiles,
                             double dark);

} // namespace vdbeam
