#pragma once

#include "errors/pass_history.h"

#include <limits>

namespace vdbeam {

/// Estimate of the error of the mean of the passes (docs/theory/error-estimate.md, "Errors").
struct ErrorEstimate {
  double mrse;        ///< expected MRSE: noise plus, where it is known, squared bias
  double low, high;   ///< 95 % interval of the picture's MRSE
  double noise;       ///< the noise, as MRSE
  double bias_mrse;   ///< the squared bias, as MRSE; unbiased, so it may be negative
  double bias;        ///< of the mean brightness, relative to it
  double bias_margin; ///< half the width of the 95 % interval of `bias`
};

/// Statistics of the noise from the history of a few pixels, to be scaled by the variance of all
/// pixels and passes.
struct NoiseStatistics {
  double correction = 1; ///< removes the bias of weighting each pixel by its own noisy mean
  double spread = 0;     ///< standard deviation of ln(true MRSE / estimated MRSE)
  int batches = 0;       ///< complete batches that were used
};

/// Correction and spread of the noise. `batches` 0 where there are fewer than 3.
NoiseStatistics noise_statistics(const PassHistory& history);

/// Statistics of the bias, as MRSE except `bias`; NaN with too little data. Each has
/// its standard error.
struct BiasStatistics {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  double mrse = unknown, mrse_error = unknown; ///< all of it, squared
  double bias = unknown, bias_error = unknown; ///< of the mean brightness, relative to it
  double blur = unknown, blur_error = unknown; ///< what of `mrse` comes from the width of kernels
  /// The part of `mrse` that whole regions share and the width of kernels does not explain.
  double hidden = unknown, hidden_error = unknown;
  /// Contribution of the truncation of the forward peak to `blur`.
  double truncation = unknown, truncation_error = unknown;
};

/// Bias of the picture, from its differences to the probes, to other kernels and between passes
/// that take more and less of the forward peak out.
BiasStatistics bias_statistics(const PassHistory& history);

/// Combines noise and bias. `noise` is the MRSE from the variance of all pixels over all passes; an
/// `unbiased` picture has no bias part.
ErrorEstimate combine_errors(double noise, const NoiseStatistics& statistics,
                             const BiasStatistics& bias, bool unbiased);

} // namespace vdbeam
