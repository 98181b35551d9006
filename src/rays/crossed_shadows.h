#pragma once

#include "medium/depth_profile.h"
#include "transport/world.h"

#include <vector>

namespace vdbeam {

/// Whether a few points along a ray, drawn by what scatters, find a light both in sight and hidden
/// by surfaces: the ray crosses shafts of light, and whether a shadow ray is lit is most of the
/// noise of single scattering there. `sampled`: per light, it is looked for. Uses random numbers of
/// its own: who sends more shadow rays where this is true must not look at what they find.
bool crosses_shadows(const World& world, const Ray& ray, const DepthProfile& profile,
                     const std::vector<bool>& sampled, Rng& rng);

} // namespace vdbeam
