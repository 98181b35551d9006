#pragma once

#include <string>

namespace vdbeam {

/// What is wrong with one key of a light, phase function or other thing that has several.
struct KeyComplaint {
  std::string key, text; ///< "cone_falloff", "must be at most ..."
};

} // namespace vdbeam
