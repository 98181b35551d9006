#pragma once

#include "layers/ray_sink.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// Light from the end of a ray that only the peak of the phase function scattered on its way along
/// the ray: what the medium without its peak lets through beyond what the scene's own does. Zero
/// where the medium keeps its peak. `behind`: light that leaves the surface at the end of the ray;
/// that of surrounding lights is added here. Shadow rays bring the light of lights that have them
/// (direct_light).
GroupedLight light_of_the_peak(const World& world, const TileRays::PixelRay& ray,
                               const GroupedLight& behind, const std::vector<bool>& sampled_lights,
                               const RaySink& sink);

} // namespace vdbeam
