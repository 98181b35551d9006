#pragma once

#include "film/pass_history.h"

namespace vdbeam {

/// What the passes tell about the error of their mean (docs/physics.md, "Errors").
struct ErrorEstimate {
  double mrse; ///< expected of the picture: noise plus, where it is known, the part of the bias
  double low, high;   ///< the picture's MRSE lies between them with a confidence of 95 %
  double noise;       ///< MRSE, the part of the noise
  double bias_mrse;   ///< MRSE, the part of the bias; an unbiased estimate, so it may be negative
  double bias;        ///< of the mean brightness, as a share of it
  double bias_margin; ///< half the width of its 95 % interval
};

/// What history says about noise, to be scaled by what all pixels and passes say.
struct NoiseShape {
  double correction = 1; ///< of weights that follow the noise they weigh
  double spread = 0;     ///< standard deviation of ln(true MRSE / estimated MRSE)
  int batches = 0;       ///< that it rests on
};

/// The correction and the spread of the noise. `batches` 0 where there are fewer than 3.
NoiseShape noise_shape(const PassHistory& history);

struct BiasShape {
  double mrse, mrse_error; ///< estimate and standard error
  double bias, bias_error; ///< of the mean brightness, as a share of it
};

/// Picture against probes. NaN where there are too few.
BiasShape bias_shape(const PassHistory& history);

/// Puts the parts together. `noise` is the spread of all pixels over all passes; a picture that is
/// `unbiased` has no part of bias.
ErrorEstimate combine_errors(double noise, const NoiseShape& shape, const BiasShape& bias,
                             bool unbiased);

} // namespace vdbeam
