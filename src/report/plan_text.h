#pragma once

#include "vdbeam/render_plan.h"

#include <string>

namespace vdbeam {

/// The value of a number of the plan, e.g. "640", or "1 to 0.46" where it changes.
std::string range_text(const PlanNumber& number);

/// The features as the metadata of images have them: "forward peak: on, but for volume.1; final
/// gathering: off (render.max_bounces limits the scattering events) for the scene; ...".
std::string features_text(const RenderPlan& plan);

/// The numbers in the same way: "light paths: 155872 (measured); kernel radius: 1 to 0.46
/// (default); ...".
std::string numbers_text(const RenderPlan& plan);

} // namespace vdbeam
