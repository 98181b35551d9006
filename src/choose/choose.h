#pragma once

#include "choose/choices.h"
#include "keys/estimator_kind.h"
#include "transport/similar_medium.h"

namespace vdbeam {

/// Chooses how the passes of a frame are rendered by an estimator, or by what `auto` may take where
/// light is carried by photons: `beam`, `gather`, or one after the other. The picture has a say:
/// photons are stored with a probability that follows what the camera sees of a cell
/// (view_importance), and kernels are as wide as noise and bias of trial maps ask for
/// (measure_kernels). Either is left out where the scene's settings decide otherwise. `worlds`: of
/// the input's world.
Choices choose(const EstimatorInput& input, const EstimatorKind& kind, PassWorlds& worlds);

/// The same for a scene whose moments are to follow it.
SceneChoices choose_for_scene(const EstimatorInput& input, const EstimatorKind& kind);

/// Truncation orders of the first passes; none where phase functions keep their forward peak.
PeakOrders choose_peak(const EstimatorInput& input, const EstimatorKind& kind);

/// The world in which photons are planned: that of a first pass that gathers along rays.
const World& planned_world(const PeakOrders& peak, PassWorlds& worlds);

} // namespace vdbeam
