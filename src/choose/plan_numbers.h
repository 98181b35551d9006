#pragma once

#include "choose/choices.h"
#include "vdbeam/render_plan.h"

namespace vdbeam {

/// The numbers by which passes are rendered, each with its origin: the scene file, a default, or
/// what pilots measured. `schedule`: of list_passes, not empty. `path` chooses its numbers pixel by
/// pixel and has none here.
std::vector<PlanNumber> describe_numbers(const EstimatorInput& input, const Choices& choices,
                                         const std::vector<PassSpec>& schedule);

} // namespace vdbeam
