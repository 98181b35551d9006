#pragma once

#include "transport/world.h"
#include "vdbeam/render.h"

namespace vdbeam {

/// What the user should know of a scene at the ends of what the estimators resolve
/// (docs/stability.md): lines for RenderResult::notes. Empty for ordinary scenes.
std::vector<std::string> limit_notes(const Scene& scene, const World& world,
                                     const RenderPlan& plan);

} // namespace vdbeam
