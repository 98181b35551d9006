#pragma once

#include "choose/pilot/gather_plan.h"
#include "photons/photon_plan.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// The same photons under kernels of one width: independent samples of what a pass would gather.
struct KernelTrial {
  double neighbours = 0;       ///< photons in a kernel, for a whole pass
  std::vector<PhotonMap> maps; ///< of independent photon passes
};

/// A pixel of the trials, in the order of the picture's rows.
struct TrialPixel {
  std::size_t pixel = 0;
  Rgb weight; ///< of squares of its error: 1 / (brightness + a little of the picture's mean)^2
};

/// Kernel errors measured on the images of two trials: means over pixels that see the medium, in
/// units like MRSE.
struct KernelErrors {
  double noise_narrow = 0, noise_wide = 0; ///< variance of a map of the trial
  double change = 0;       ///< mean square change of the mean picture between the trials, unbiased
  double change_error = 0; ///< its standard error
  std::vector<TrialPixel> pixels; ///< a few of them
  RegressionTrial regression;     ///< what it would do to the pictures in narrow kernels
};

/// Looks at the trials through some tiles of the camera's picture. Adds to `rays` those that it
/// shot. `plan`: how the trials' photons were chosen. A pure function of its arguments, for any
/// number of threads.
KernelErrors measure_kernels(const EstimatorInput& input, const PhotonPlan& plan,
                             const KernelTrial& narrow, const KernelTrial& wide, const RngKey& key,
                             std::uint64_t& rays);

/// How noise and bias of a picture follow from the number of photons in a kernel. Noise falls with
/// a power of it that the trials measure; bias is assumed to grow with another power.
class KernelModel {
public:
  /// `paths_share`: light paths of a trial's map over those of a pass. `alpha`: by which kernels
  /// shrink over the passes (radius_scale).
  KernelModel(const KernelTrial& narrow, const KernelTrial& wide, const KernelErrors& errors,
              double paths_share, double alpha);

  /// Photons in a kernel at which noise and bias together are least.
  double best_neighbours() const;
  /// Mean square error of the photons' light in an image of `passes` passes.
  double error(double neighbours, int passes) const;

private:
  struct Balance {
    double noise = 0;       ///< in narrow kernels
    double bias_factor = 0; ///< of their squared bias
  };
  Balance balance(int passes) const;
  /// Expected squared bias: the measured value, combined with a prior from other scenes, which is
  /// weighted by the measurement's standard error.
  double expected_bias(double measured, double error) const;

  double narrow_, wide_;   ///< photons in the kernels of the trials
  double noise_;           ///< of one pass in narrow kernels; 0: not known
  double bias_;            ///< expected square of it in narrow kernels; 0: not known
  double noise_power_ = 1; ///< by which noise falls
  double alpha_;
};

/// Result of a trial: error model by kernel width, sampled pixels, and the regression over pixels.
struct KernelTrialResult {
  KernelModel model;
  std::vector<TrialPixel> pixels;
  RegressionTrial regression;
};

} // namespace vdbeam
