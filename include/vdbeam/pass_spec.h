#pragma once

#include <cstdint>
#include <string_view>

namespace vdbeam {

/// Specification of a pass, known before the pass begins. An estimator renders it and makes no
/// further decisions.
struct PassSpec {
  int pass = 0;               ///< number, from 0
  std::string_view estimator; ///< estimator that renders it
  /// The highest Legendre moment that phase functions keep where light paths scatter; 0: the phase
  /// functions as they are.
  int peak_order = 0;
  float kernel_scale = 1; ///< radius of the kernels over that of the first pass
  double neighbours = 0;  ///< photons in an adaptive kernel
  std::uint64_t light_paths = 0;
  int gather_walks = 0;        ///< from each camera ray, for final gathering
  float regression_radius = 0; ///< radius of the regression over pixels [pixels]
};

} // namespace vdbeam
