#pragma once

#include "choose/choices.h"
#include "choose/pilot/kernel_pilot.h"
#include "keys/estimator_kind.h"

#include <optional>

namespace vdbeam {

/// From which pass on light is gathered finally, by what a pilot finds of the noise of walks; empty
/// where it never pays, or where it cannot be done. `trial`: photons in narrow kernels, of maps of
/// `paths_share` of a pass's light paths.
std::optional<GatherPlan> choose_gather(const EstimatorInput& input, const EstimatorKind& kind,
                                        const Choices& choices, const KernelTrial& trial,
                                        double paths_share);

} // namespace vdbeam
