#pragma once

#include "choose/pass_renderer.h"

namespace vdbeam {

/// Renders the lights of each group by themselves, one after the other, and adds them up: light is
/// additive, so the picture is what it is without groups, but for the noise, and PassImage::groups
/// add up to it. `scene` says to which group a light of the input's world belongs. Where the input
/// follows choices of the scene, they are those of the groups.
std::unique_ptr<PassRenderer> make_group_passes(const Scene& scene, const EstimatorType& type,
                                                const EstimatorInput& input);

/// The choices of each group, in their order, which the groups of the scene's moments follow.
std::vector<SceneChoices> choose_for_groups(const Scene& scene, const EstimatorType& type,
                                            const EstimatorInput& input);

} // namespace vdbeam
