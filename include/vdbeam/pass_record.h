#pragma once

#include <cstdint>

namespace vdbeam {

/// One finished pass, as the report lists it.
struct PassRecord {
  int pass = 0;              ///< number of passes so far
  double seconds = 0;        ///< since rendering began (reading excluded)
  std::uint64_t photons = 0; ///< stored in this pass
  /// MRSE to expect of the image so far: noise, from the spread of the passes, and bias, as far as
  /// it is known. NaN or infinite: unknown.
  double error_estimate = 0;
  double error_low = 0, error_high = 0; ///< the image's MRSE lies between, with 95 % confidence
  double noise_estimate = 0;            ///< the part of the noise
  double bias_mrse_estimate = 0;        ///< the part of the bias; may come out negative
  double bias_estimate = 0;             ///< mean brightness of the image against the truth, - 1
  double bias_margin = 0;               ///< half of its 95 % interval
  double rmse = 0, mrse = 0, relmse = 0, bias = 0; ///< against the reference, where one is given
  bool has_reference = false;
};

} // namespace vdbeam
