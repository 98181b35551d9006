#pragma once

#include "estimators/kernel_pilot.h"

#include <optional>

namespace vdbeam {

/// Walks from each camera ray of a pass that gathers finally.
inline constexpr int final_gather_walks = 20;

/// The pass from which on photons are to be gathered by walks (FinalGather), where
/// `render.final_gather` is automatic: a later one if the forecast error after many passes is less
/// than that of gathering along camera rays. `trial`: maps of `paths_share` of a pass's light paths
/// each, whose kernels led to the plan. None: never. A pure function of its arguments.
std::optional<int> choose_final_gather(const EstimatorInput& input, const PhotonPlan& plan,
                                       const KernelTrial& trial, double paths_share);

} // namespace vdbeam
