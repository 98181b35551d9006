#pragma once

#include "phase/truncated_phase.h"

namespace vdbeam {

/// The aureole about a light: what the forward peak of a phase function scatters any number of
/// times and nothing else in the medium scatters.
///
/// A peak that delta-M takes out, f q = p - (1 - f) p', has the Legendre moments q_l = 1 below its
/// order M and chi_l / f from M on. Over the optical depth tau of the peak's scattering the number
/// of its scatterings has a Poisson distribution, and by the small-angle approximation, in which
/// light stays on its straight line, their angles add up by convolution: the moments of the light's
/// directions become exp(-tau (1 - q_l)).
///
/// TMS counts q once for each scattering, so it is too bright towards the light; Nakajima and
/// Tanaka (1988) correct that to the second order (IMS). Here all orders are summed.
class Aureole {
public:
  Aureole() = default;
  /// `order`: M, of `truncated`, which is what truncate_peak makes of `phase`, with forward > 0.
  Aureole(const PhaseFunction& phase, const TruncatedPhase& truncated, int order);

  /// f times the convolution of q with the directions of light that comes through `depth` of the
  /// peak [1/sr]; may be negative, as the truncated series p' may. `peak`: f q(cosine).
  float spread(float peak, float cosine, float depth) const;

private:
  std::vector<float> table_; ///< what scatterings before the last add, by depth and by angle
  float first_angle_ = 1, angles_per_log_ = 0;
};

} // namespace vdbeam
