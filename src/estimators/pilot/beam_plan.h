#pragma once

#include "photons/photon_plan.h"

namespace vdbeam {

/// A plan of photons that camera rays gather, in which the picture has a say: photons are stored
/// with a probability that follows what the camera sees of a cell (view_importance), and kernels
/// are as wide as noise and bias of trial maps ask for (measure_kernels). Either is left out where
/// the scene's settings decide otherwise.
PhotonPlan plan_beam_photons(const EstimatorInput& input);

/// The plan of a scene's photons, which its moments follow.
ScenePhotons plan_scene_photons(const EstimatorInput& input);

} // namespace vdbeam
