#pragma once

#include "choose/choices.h"
#include "choose/pilot/kernel_pilot.h"
#include "keys/estimator_kind.h"

#include <optional>

namespace vdbeam {

/// Plan of final gathering, from the noise of walks that a pilot measures; empty if it is never
/// better, or impossible. `trial`: photons in narrow kernels, of maps of
/// `paths_share` of a pass's light paths.
std::optional<GatherPlan> choose_gather(const EstimatorInput& input, const EstimatorKind& kind,
                                        const Choices& choices, const KernelTrial& trial,
                                        double paths_share);

} // namespace vdbeam
