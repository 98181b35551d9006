#pragma once

#include <array>
#include <cstddef>

namespace vdbeam {

/// Effect of regression over pixels (PixelRegression) on an image, by its radius.
struct RegressionTrial {
  static constexpr std::array<float, 10> radii = {0,    0.05f, 0.1f, 0.25f, 0.5f,
                                                  0.7f, 1,     1.4f, 2,     2.8f}; ///< [pixels]
  /// Variance of what is fitted over that of what each pixel has of its own.
  std::array<double, radii.size()> noise = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  double blur = 0; ///< squared bias by the widest, in units like MRSE

  /// Squared bias by one of the radii.
  double blur_of(std::size_t radius) const;
};

/// Plan of final gathering (FinalGather).
struct GatherPlan {
  double noise = 0;         ///< variance of what the most walks find, in units like MRSE
  double photons_noise = 0; ///< variance of the photons of a pass, as walks see it
  RegressionTrial regression;

  /// Mean square error of the photons' light after the time of `passes_along` passes that gather
  /// along camera rays; with the best radius, or with one of the trial's.
  double error_after(double passes_along) const;
  double error_after(double passes_along, std::size_t radius) const;
  /// The radius [pixels] of a pass: smaller from pass to pass, so that its bias vanishes as noise
  /// does.
  float regression_radius(int pass) const;
  /// Walks from each camera ray of a pass.
  int walks(int pass) const;

private:
  std::size_t best_radius(double passes_along) const;
};

} // namespace vdbeam
