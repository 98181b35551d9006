#pragma once

namespace vdbeam {

/// Numbers that describe an image, so that a wrong one is noticed.
struct PictureFacts {
  /// Optical depth of the medium along the deepest of a grid of camera rays, in the largest
  /// channel.
  double optical_depth = 0;
  /// Mean over the pixels: of volumes, surfaces and caught shadows. NaN: there is no layer alpha.
  double opacity = 0;
  double black = 0;    ///< fraction of the pixels without any light
  double over_one = 0; ///< fraction of the pixels with a channel above 1
};

} // namespace vdbeam
