#include "render/error_record.h"

namespace vdbeam {

PassRecord error_record(const Film& film, bool unbiased) {
  const ErrorEstimate estimate = film.error_estimate(unbiased);
  PassRecord record;
  record.pass = film.passes();
  record.error_estimate = estimate.mrse;
  record.error_low = estimate.low;
  record.error_high = estimate.high;
  record.noise_estimate = estimate.noise;
  record.bias_mrse_estimate = estimate.bias_mrse;
  record.bias_estimate = estimate.bias;
  record.bias_margin = estimate.bias_margin;
  return record;
}

} // namespace vdbeam
