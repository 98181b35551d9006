#pragma once

#include "rays/profile_shading.h"
#include "rays/tile_rays.h"
#include "tuning/constants.h"

#include <algorithm>
#include <array>

namespace vdbeam {

/// What is seen of surfaces at the ends of a tile's rays, in their order.
using TileSurfaces = std::array<SeenSurface, TileRays::count>;

/// Calls visit(ray) for the rays of the tile up to tuning::reach_of_effort pixels from a ray's,
/// itself among them, that show the same surface, or none as it does; row by row.
template <class Visit>
void for_each_near(const TileSurfaces& seen, int ray, const Visit& visit) {
  const int reach = tuning::reach_of_effort, last = TileRays::across - 1;
  const int x = TileRays::column(ray), y = TileRays::row(ray);
  const int surface = seen[static_cast<std::size_t>(ray)].surface;
  for (int py = std::max(0, y - reach); py <= std::min(last, y + reach); ++py)
    for (int px = std::max(0, x - reach); px <= std::min(last, x + reach); ++px)
      if (const int other = TileRays::ray_at(px, py);
          seen[static_cast<std::size_t>(other)].surface == surface)
        visit(other);
}

/// How many more samples of a matt surface each ray of a tile should take so that its noise, after
/// the fit over pixels (SurfaceFit), and its time balance those of the rest of the picture: as the
/// square root of the variance. Only the pixels around decide, not the pixel's own samples, which
/// would bias their mean. `passes`: expected of the render.
std::array<MattSamples, TileRays::count> more_samples(const Medium& medium, const TileRays& rays,
                                                      const TileSurfaces& seen, int passes);

} // namespace vdbeam
