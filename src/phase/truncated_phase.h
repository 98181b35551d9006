#pragma once

#include "phase/phase_function.h"

#include <vector>

namespace vdbeam {

/// Legendre moments chi_0 ... chi_{count - 1} of a phase function given by lobes, the means of
/// P_l(cos theta) over its directions; chi_0 = 1, chi_1 is the mean cosine. In closed form.
std::vector<double> legendre_moments(const PhaseFunction& phase, int count);

/// A phase function as the sum of a forward peak, treated as no scattering at all, and a smooth
/// rest: the delta-M method (Wiscombe, *The Delta-M Method*, 1977),
///   p = forward * delta(1 - cos) / (2 pi) + (1 - forward) * p',
///   forward = chi_M,  moments of p' = (chi_l - chi_M) / (1 - chi_M) for l < M, 0 from M on.
struct TruncatedPhase {
  float forward = 0; ///< fraction of scattering in the peak; 0: the phase function is unchanged
  PhaseFunction gathered; ///< p' as a polynomial; may be negative, for use under an integral only
  /// To draw directions from: p' where it is positive, tilted so that the mean cosine stays.
  PhaseFunction traced;
};

/// Orders that `truncate_peak` takes.
inline constexpr int least_truncation_order = 4, most_truncation_order = 12;

/// `order` is M. Phase functions without a forward peak worth taking out stay as they are.
TruncatedPhase truncate_peak(const PhaseFunction& phase, int order);

} // namespace vdbeam
