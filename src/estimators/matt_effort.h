#pragma once

#include "rays/profile_shading.h"
#include "rays/tile_rays.h"

#include <array>

namespace vdbeam {

/// What is seen of surfaces at the ends of a tile's rays, in their order.
using TileSurfaces = std::array<SeenSurface, TileRays::count>;

/// How many more samples of a matt surface each ray of a tile should take so that its noise, after
/// the fit over pixels (SurfaceFit), and its time balance those of the rest of the picture: as the
/// square root of the variance. Only the pixels around decide, not the pixel's own samples, which
/// would bias their mean. `pass`: of the fit.
std::array<MattSamples, TileRays::count> more_samples(const Medium& medium, const TileRays& rays,
                                                      const TileSurfaces& seen, int image_width,
                                                      int pass);

} // namespace vdbeam
