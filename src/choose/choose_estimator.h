#pragma once

#include "choose/pass_renderer.h"

#include <optional>
#include <string>

namespace vdbeam {

/// The estimator that `estimator = "auto"` chooses in a scene.
struct EstimatorChoice {
  EstimatorType type = EstimatorType::beam; ///< of the first pass
  std::string reason;                       ///< one clause
  double lead = 0; ///< forecast of how many times the error of photons `path` has; 0: none was made
  std::unique_ptr<FramePasses> photons; ///< ready to render, where photons were chosen
};

/// Why photons would be rare and bright however many there are, so that `auto` takes path without a
/// trial; nothing where they are not. A light path of a few thousand collisions leaves its photons
/// where nobody sees them. Asking takes a few light paths.
std::optional<std::string> why_photons_are_rare(const EstimatorInput& input);

/// Chooses between the estimators that gather photons and `path`: the one with the smaller error
/// for the same work, by a short trial: the kernel pilot's forecast of noise and bias against the
/// spread of a few pixels that are path traced twice. Work is counted in collisions and photons,
/// not by a clock, so that every machine chooses the same. `photon_input`, `path_input`: with the
/// plans of the two; they must outlive the estimator.
EstimatorChoice choose_estimator(const EstimatorInput& photon_input,
                                 const EstimatorInput& path_input);

} // namespace vdbeam
