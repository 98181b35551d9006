#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Paths of the keys ("light.0.exposure") by which two scenes differ, in the order of the keys.
/// A table that only one of them has is named as a whole ("light.2").
std::vector<std::string> changed_keys(const Scene& before, const Scene& after);

} // namespace vdbeam
