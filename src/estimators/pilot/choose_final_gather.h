#pragma once

#include "estimators/pilot/kernel_pilot.h"

#include <optional>

namespace vdbeam {

/// How passes gather finally, where `render.final_gather` is automatic: from the first pass on or
/// from a later one, if the forecast error after many passes is less than that of gathering along
/// camera rays. `trial`: maps of `paths_share` of a pass's light paths each, whose kernels led to
/// the plan. None: never. A pure function of its arguments.
std::optional<WalkPlan> choose_final_gather(const EstimatorInput& input, const PhotonPlan& plan,
                                            const KernelTrial& trial, double paths_share);

} // namespace vdbeam
