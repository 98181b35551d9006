#pragma once

#include "phase/phase_function.h"

#include <array>

namespace vdbeam {

/// A density of the scattering angle, from which points near a lamp are drawn: half of it is even,
/// half follows the phase functions p of a medium (their mean),
///   g(theta) = 1 / (2 pi) + p(cos theta) / (2 I),  I = the integral of p(cos theta) d theta
/// over 0 to pi. The light of a lamp along a ray is p(cos theta) d theta up to transmittance, so
/// points by g see a sharp peak of p as often as it counts (Georgiev et al., Joint Importance
/// Sampling of Low-Order Volumetric Scattering, 2013).
class ScatteringAngles {
public:
  /// At least one phase function.
  explicit ScatteringAngles(const std::vector<PhaseFunction>& phases);

  /// Share of the angles up to `angle` [rad], from 0 to 1.
  double cumulative(double angle) const;
  /// The angle up to which this share lies.
  double inverse(double share) const;
  /// g [1/rad].
  double density(double angle) const;

private:
  static constexpr int bins = 128;
  /// Bins are narrow about 0, where phase functions have their peaks.
  static double edge(int bin);
  static int bin_of(double angle);

  std::array<double, bins + 1> cumulative_{}; ///< at the bins' edges; linear between them
};

} // namespace vdbeam
