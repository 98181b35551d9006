#pragma once

#include "rays/estimator_input.h"
#include "vdbeam/render.h"

#include <optional>

namespace vdbeam {

/// Notes about scenes at the limits of the estimators
/// (docs/developer/extreme-scenes.md): lines for RenderResult::notes. Empty for ordinary scenes.
std::vector<std::string> limit_notes(const Scene& scene, const EstimatorInput& input);

/// A line where the camera's rays met next to no photons, whatever the reason: then most of the
/// light that the medium scatters is in no pixel. Counts of rays that end at surfaces hold other
/// look-ups too, so scenes with surfaces get none.
std::optional<std::string> starved_note(const Scene& scene, const RenderPlan& plan,
                                        const RenderStatistics& counts);

} // namespace vdbeam
