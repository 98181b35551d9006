#pragma once

namespace vdbeam {

/// Where a surface shows a picture: (0, 0) is the picture's lower left corner, (1, 1) its upper
/// right one.
struct Uv {
  float u = 0, v = 0;
};

} // namespace vdbeam
