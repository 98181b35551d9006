#pragma once

#include "errors/pass_history.h"
#include "estimators/path/path.h"

namespace vdbeam {

/// A few path-traced camera rays of each pass, with which a biased estimator's image is compared to
/// estimate its bias (Film::error_estimate). They do not change the image.
class BiasProbe {
public:
  /// `input` has the plan of the path estimator (plan_paths). `pixels` are of the window; of the
  /// window's pixels the share render.bias_rays is probed per pass.
  BiasProbe(const EstimatorInput& input, const PixelRegion& window,
            const std::vector<std::size_t>& pixels);

  /// The pixels whose turn it is in this pass. A pure function of scene, seed, frame and pass.
  std::vector<PixelValue> trace(const PassSpec& spec, RenderStatistics& statistics);

private:
  PathEstimator path_;
  PixelRegion window_;
  int image_width_;
  std::vector<std::size_t> pixels_; ///< that are probed, spread over the window
  std::size_t period_;              ///< passes until a pixel's next turn
};

/// The pixels of the image, in ascending order, at which passes measure their blur: of the
/// window's `pixels`, or of some of them where that would take long.
std::vector<std::size_t> choose_blur_pixels(const PixelRegion& window, int image_width,
                                            const std::vector<std::size_t>& pixels);

} // namespace vdbeam
