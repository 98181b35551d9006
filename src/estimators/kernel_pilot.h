#pragma once

#include "estimators/photon_plan.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// The same photons under kernels of one width: independent samples of what a pass would gather.
struct KernelTrial {
  double neighbours = 0;       ///< photons in a kernel, for a whole pass
  std::vector<PhotonMap> maps; ///< of independent photon passes
};

/// What the pictures of two trials tell about kernels, per pixel in units like MRSE; only ratios
/// count.
struct KernelErrors {
  double noise_narrow = 0, noise_wide = 0; ///< variance of a map of the trial
  double change = 0;       ///< mean square change of the mean picture between the trials, unbiased
  double change_error = 0; ///< its standard error
};

/// Looks at the trials through some tiles of the camera's picture. Adds to `rays` those that it
/// shot. `plan`: how the trials' photons were chosen. A pure function of its arguments, for any
/// number of threads.
KernelErrors measure_kernels(const EstimatorInput& input, const PhotonPlan& plan,
                             const KernelTrial& narrow, const KernelTrial& wide, const RngKey& key,
                             std::uint64_t& rays);

/// Photons in a kernel at which the noise and the bias of a picture together are least. Noise falls
/// with a power of their number that the trials tell; bias is taken to grow with
/// another (docs/decisions.md).
/// `paths_share`: light paths of a trial's map over those of a pass.
double best_neighbours(const KernelTrial& narrow, const KernelTrial& wide,
                       const KernelErrors& errors, double paths_share, double alpha);

} // namespace vdbeam
