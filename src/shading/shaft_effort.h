#pragma once

#include "math/rng.h"
#include "rays/tile_rays.h"
#include "shading/matt_effort.h"

#include <array>
#include <vector>

namespace vdbeam {

/// Factors of the shadow rays of a tile's rays, in their order: more where shafts of light are near
/// (ShaftLight), found by the pixels around that show the same surface, or none. `seen`: surfaces
/// at the ends of the rays; `sampled`: per light, it has shadow rays.
std::array<float, TileRays::count> shaft_effort(const World& world,
                                                const std::vector<bool>& sampled,
                                                const TileRays& rays, const TileSurfaces& seen,
                                                const RngKey& key);

} // namespace vdbeam
