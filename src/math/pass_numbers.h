#pragma once

#include <cstdint>

namespace vdbeam {

/// Numbers of passes, by which random numbers are drawn (RngKey::pass). The passes of a frame count
/// from 0 over all machines that render them (PassSpec::pass). Whatever else draws random numbers
/// has numbers of its own, which count down from 2^64 - 1, far from those of passes.
///
/// The kernel pilot has the numbers below `pilot_pass`, one for each of its maps.
inline constexpr std::uint64_t pilot_pass = ~std::uint64_t(0);
inline constexpr std::uint64_t layout_pass = pilot_pass - 7;        ///< rays of a deep layout
inline constexpr std::uint64_t guide_pass = pilot_pass - 16;        ///< of the path guide
inline constexpr std::uint64_t guided_pilot_pass = guide_pass - 1;  ///< pilot with a path guide
inline constexpr std::uint64_t sight_pass = guide_pass - 2;         ///< lights in sight
inline constexpr std::uint64_t limit_pass = guide_pass - 3;         ///< limit of bounces
inline constexpr std::uint64_t rare_photons_pass = pilot_pass - 64; ///< lengths of light paths
/// Estimators count passes by `int`: -1 is 2^64 - 1.
inline constexpr int quick_look_pass = -100;
inline constexpr int first_trial_pass = -200;                        ///< photons against `path`
inline constexpr std::uint64_t first_effort_pass = pilot_pass - 300; ///< counts down: `path`

} // namespace vdbeam
