#pragma once

#include "vdbeam/image.h"

namespace vdbeam {

/// Error of an image v against a reference r, over all pixels and the channels R, G, B, in linear
/// RGB. Definitions: docs/theory/error-estimate.md.
struct ImageError {
  double rmse = 0;   ///< sqrt(mean((v - r)^2))
  double mrse = 0;   ///< mean((v - r)^2 / (r + 0.01)^2)
  double relmse = 0; ///< mean((v - r)^2 / (r^2 + 0.01)) without the worst 0.1 % of pixels
  double bias = 0;   ///< mean(v) / mean(r) - 1
  double flip =
      0; ///< mean FLIP (Andersson et al. 2020) at 67 pixels per degree; only compare_images
  double mrse_error = 0; ///< standard error of mrse; only with two references
};

/// rmse, mrse, relmse, bias. Throws InputError where sizes differ or R, G, B are missing.
ImageError image_error(const Image& image, const Image& reference);
/// The same, with FLIP.
ImageError compare_images(const Image& image, const Image& reference);
/// Error of an image v against the truth, estimated from two independent, unbiased and noisy
/// images `a` and `b` of it; their noise cancels on average:
///   mrse = mean((v - a)(v - b) / (m + 0.01)^2),  rmse^2 and relmse with the same product,
///   bias = mean(v) / mean(m) - 1.
/// m is the mean of a and b, over 5 x 5 pixels where their noise is more than 0.01 as an MRSE, so
/// that it does not weigh itself. No pixel is left out of relmse. Where v is nearly exact mrse may
/// come out negative; rmse is then 0. mrse_error follows from how much the mean product differs
/// between blocks of 4 x 4 pixels. flip is not set. Throws InputError like the above.
ImageError image_error(const Image& image, const Image& a, const Image& b);
/// Temporal error of two successive frames: the error of their difference, which is visible as
/// flicker, mean((dv - dr)^2 / (r + 0.01)^2) with dv = after - before, dr the references'
/// difference and r their mean. Two frames with independent noise and an MRSE of e each have a
/// temporal error of 2 e. Throws InputError like image_error.
double temporal_error(const Image& before, const Image& after, const Image& reference_before,
                      const Image& reference_after);

} // namespace vdbeam
