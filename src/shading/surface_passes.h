#pragma once

#include <array>

namespace vdbeam {

/// Passes of the render for which a pass balances noise and bias: twice those until its end, since
/// nobody knows the number in advance.
constexpr int expected_passes(int pass) {
  return 2 * (pass + 1);
}

/// Radii of a pass's fits over the pixels of a surface: the narrow one in pixels, the wide one in
/// steps of three of them; 0: none. They shrink, so that the bias vanishes as the noise does.
std::array<float, 2> surface_fit_radii(int pass);

} // namespace vdbeam
