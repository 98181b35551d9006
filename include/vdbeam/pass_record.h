#pragma once

#include <cstdint>

namespace vdbeam {

/// The state of the image after a pass, as the report lists it.
struct PassRecord {
  int pass = 0;              ///< number of passes so far
  double seconds = 0;        ///< since rendering began (reading excluded)
  std::uint64_t photons = 0; ///< stored in this pass
  /// Expected MRSE of the image so far: noise, from the variance of the passes, and bias, as far as
  /// it can be estimated. NaN or infinite: unknown.
  double error_estimate = 0;
  double error_low = 0, error_high = 0; ///< 95 % interval of the image's MRSE
  double noise_estimate = 0;            ///< the noise's part of error_estimate
  double bias_mrse_estimate = 0;        ///< the bias's part; unbiased, so it may be negative
  double bias_estimate = 0;             ///< mean brightness over the true mean brightness, - 1
  double bias_margin = 0;               ///< half of its 95 % interval
  double rmse = 0, mrse = 0, relmse = 0, bias = 0; ///< against the reference, where one is given
  bool has_reference = false;
};

} // namespace vdbeam
