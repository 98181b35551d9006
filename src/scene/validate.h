#pragma once

#include "vdbeam/scene.h"

#include <functional>
#include <string>

namespace vdbeam {

/// Gives the beginning of a message about a key, e.g. "cloud.toml:14", from the key's path.
using KeyLocator = std::function<std::string(const std::string& path)>;

/// Checks what no single key can tell: directions that are not 0, a camera that sees something,
/// bounds in order. Throws InputError.
void validate_consistency(const Scene& scene, const KeyLocator& locate);

} // namespace vdbeam
