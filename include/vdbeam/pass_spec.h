#pragma once

#include <cstdint>
#include <string_view>

namespace vdbeam {

/// Specification of a pass, known before the pass begins. An estimator renders it and makes no
/// further decisions.
struct PassSpec {
  /// Number, from 0, over all machines that render passes of the frame: pass ranges of partial
  /// images have the same numbers. Records, messages and images give the number of finished passes
  /// instead, from 1. A draft is a frame of its own, whose passes count from 0.
  int pass = 0;
  std::string_view estimator; ///< estimator that renders it
  /// The highest Legendre moment that phase functions keep where light paths scatter; 0: the phase
  /// functions as they are.
  int peak_order = 0;
  float kernel_scale = 1; ///< radius of the kernels over that of the first pass
  double neighbours = 0;  ///< photons in an adaptive kernel
  std::uint64_t light_paths = 0;
  int gather_walks = 0;        ///< from each camera ray, for final gathering
  float regression_radius = 0; ///< radius of the regression over pixels [pixels]
  /// Passes of the render for which the pass balances noise and bias.
  int expected_passes = 0;
  /// Radius of the fit over the pixels of a surface [pixels]; 0: there is none.
  float surface_fit_radius = 0;
  /// Radius of the second, wide fit, in steps of three pixels; 0: there is none.
  float wide_surface_fit_radius = 0;
  int motion_sample = -1; ///< index of the motion sample; -1: nothing moves
  /// Which pixels the path-traced rays of the bias estimate probe: pixels take turns.
  int probe_turn = 0;
};

} // namespace vdbeam
