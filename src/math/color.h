#pragma once

#include "vdbeam/vec.h"

namespace vdbeam {

/// The same in red, green and blue.
inline bool is_grey(const Rgb& c) {
  return c.x == c.y && c.y == c.z;
}

} // namespace vdbeam
