#pragma once

#include "vdbeam/scene.h"

#include <string>
#include <vector>

namespace vdbeam {

/// The group of the lights that have none, and of volumes that glow.
inline constexpr const char* rest_group = "rest";

/// The groups of a scene's lights, in the order of their names, "rest" among them for lights
/// without one and volumes that glow, where there are any; empty where no light has a group.
std::vector<std::string> light_group_names(const Scene& scene);

} // namespace vdbeam
