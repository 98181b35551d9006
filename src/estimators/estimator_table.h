#pragma once

#include "estimators/estimator.h"
#include "keys/estimator_kind.h"

namespace vdbeam {

/// Stages of estimators that gather photons as the camera sees them.
inline constexpr StageSet gather_stages = {
    Stage::surfaces,          Stage::photons,           Stage::surface_photons,
    Stage::photon_importance, Stage::kernel_pilot,      Stage::map,
    Stage::neighbours,        Stage::photon_directions, Stage::photon_color,
    Stage::depth_profiles,    Stage::emission,          Stage::shadow_rays,
    Stage::spectral_tracking, Stage::beam_query,        Stage::bias};

extern const EstimatorKind auto_estimator, beam_estimator, gather_estimator, march_estimator,
    path_estimator;

} // namespace vdbeam
