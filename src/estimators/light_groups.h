#pragma once

#include "estimators/estimator.h"
#include "photons/photon_plan.h"

namespace vdbeam {

/// An estimator that renders the lights of each group by themselves, one after the other, and adds
/// them up: light is additive, so the picture is what it is without groups, but for the noise, and
/// PassImage::groups add up to it. `scene` says to which group a light of the input's world
/// belongs. Where the input follows photons of the scene, they are those of the groups.
std::unique_ptr<Estimator> make_grouped_estimator(const Scene& scene, const EstimatorInput& input);

/// The photons of each group, in their order, which the groups of the scene's moments follow.
std::vector<ScenePhotons> plan_group_photons(const Scene& scene, const EstimatorInput& input);

} // namespace vdbeam
