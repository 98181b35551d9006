#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// Paths of the keys ("light.0.exposure") by which two scenes differ, in the order of the keys.
std::vector<std::string> changed_keys(const Scene& before, const Scene& after);

} // namespace vdbeam
