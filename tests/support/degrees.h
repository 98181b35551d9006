#pragma once

#include <numbers>

namespace vdbeam {

inline constexpr double degrees = std::numbers::pi / 180; ///< [rad]

} // namespace vdbeam
