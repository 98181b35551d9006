#pragma once

#include "estimators/beam/beam.h"

#include <string>

namespace vdbeam {

/// What `estimator = "auto"` stands for in a scene.
struct EstimatorChoice {
  EstimatorType type = EstimatorType::beam;
  std::string reason; ///< one clause
  double lead = 0; ///< forecast of how many times the error of `beam` `path` has; 0: none was made
  std::unique_ptr<BeamEstimator> beam; ///< ready to render, where it was chosen
};

/// Of `beam` and `path` the one whose picture has the smaller error for the same work, as far as a
/// short trial tells: the kernel pilot's forecast of noise and bias against the spread of a few
/// pixels that are path traced twice. Work is counted in collisions and photons, not by a clock, so
/// that every machine chooses the same. `beam_input`, `path_input`: with the plans of the two; they
/// must outlive the estimator.
EstimatorChoice choose_estimator(const EstimatorInput& beam_input,
                                 const EstimatorInput& path_input);

} // namespace vdbeam
