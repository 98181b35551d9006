#pragma once

#include "choose/choices.h"
#include "choose/pilot/kernel_pilot.h"
#include "keys/estimator_kind.h"

#include <optional>

namespace vdbeam {

/// Whether and how walks from camera rays gather photons.
struct GatherChoice {
  std::optional<GatherPlan> plan; ///< empty where final gathering is never better, or impossible
  double lead = 0;                ///< Choices::lead_of_gather
};

/// Chooses by the noise of walks that a pilot measures. `trial`: photons in narrow kernels, of maps
/// of `paths_share` of a pass's light paths.
GatherChoice choose_gather(const EstimatorInput& input, const EstimatorKind& kind,
                           const Choices& choices, const KernelTrial& trial, double paths_share);

} // namespace vdbeam
