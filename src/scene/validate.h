#pragma once

#include "vdbeam/scene.h"

#include <functional>
#include <string>

namespace vdbeam {

/// Gives the beginning of a message about a key, e.g. "cloud.toml:14", from the key's path.
using KeyLocator = std::function<std::string(const std::string& path)>;

/// Checks that involve several keys: directions that are not 0, a valid camera,
/// bounds in order. Throws InputError.
void validate_consistency(const Scene& scene, const KeyLocator& locate);

} // namespace vdbeam
