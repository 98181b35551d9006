#pragma once

#include "estimators/estimator.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// What the user should know of a scene at the ends of what the estimators resolve
/// (docs/stability.md): lines for RenderResult::notes. Empty for ordinary scenes.
std::vector<std::string> limit_notes(const Scene& scene, const EstimatorInput& input);

} // namespace vdbeam
