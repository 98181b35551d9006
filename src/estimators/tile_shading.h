#pragma once

#include "estimators/surface_shading.h"
#include "rays/estimator_input.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// What a thread keeps from tile to tile.
struct TileScratch {
  TileRays rays;
  BeamTile tile;
  RenderStatistics statistics;
};

/// What a ray of the picture sees but for what it gathers from the photon map: direct light, and
/// what is seen through the medium. It is added to pixel `target` of `image`. `surface`: radiance
/// of the surface at which the ray ends, if it does. `rays`: how many rays of the pixel share its
/// shadow rays.
void shade_ray(const EstimatorInput& input, const PhotonPass& photons,
               const TileRays::PixelRay& ray, const SeenSurface& surface, const RngKey& key,
               std::size_t target, PassImage& image, RenderStatistics& counts, int rays = 1);

/// The camera side of a pass that `beam` and `march` share: rays and depth profiles tile by tile,
/// direct light, what is seen through the medium, and the stage times. `refine`: edges are seen by
/// several rays (is_uneven). `gather` adds what the
/// photon map gives to image.indirect for the tile's rays, and its counts to scratch.statistics;
/// `gather_along` gives the same for the rays that go on behind mirrors and glass.
void shade_tiles(const EstimatorInput& input, const PhotonPass& photons, int pass, bool refine,
                 PassImage& image, RenderStatistics& statistics,
                 const std::function<void(TileScratch& scratch, const RngKey& key)>& gather,
                 const GatherAlong& gather_along);

} // namespace vdbeam
