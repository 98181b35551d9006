#pragma once

#include "rays/estimator_input.h"
#include "rays/profile_shading.h"
#include "rays/tile_rays.h"
#include "rays/uneven_pixels.h"
#include "shading/matt_effort.h"
#include "shading/surface_shading.h"

#include "vdbeam/pass_spec.h"

namespace vdbeam {

class BlurProbe;

/// Buffers that a thread keeps from tile to tile.
struct TileScratch {
  TileRays rays;
  BeamTile tile;
  TileSurfaces seen; ///< at the ends of the rays; nothing without surfaces
  RenderStatistics statistics;
  /// Opacity and depth of the medium alone, whatever surfaces stand in it: mean over the rays of
  /// each pixel.
  std::array<OpacityAndDepth, TileRays::count> medium{};
  std::array<EndOfRay, TileRays::count> ends{}; ///< of the rays; nothing without surfaces
  std::array<bool, TileRays::count> uneven{};   ///< pixels that several rays see
  std::array<float, TileRays::count> effort{};  ///< factor of the shadow rays of each pixel
};

/// The pixel to which a ray adds its light, and the counters of its work.
struct PixelTarget {
  std::size_t pixel;
  PassImage& image;
  RenderStatistics& counts;
};

/// Adds what a ray of the picture sees but for what it gathers from the photon map: direct light,
/// and what is seen through the medium. `surface`: what is seen of the surface at which the ray
/// ends, if it does. `effort`: factor of the number of shadow rays. Returns opacity and depth of
/// the medium alone.
OpacityAndDepth shade_ray(const EstimatorInput& input, const PhotonPass& photons,
                          const TileRays::PixelRay& ray, const RngKey& key,
                          const PixelTarget& target, const SeenSurface& surface = {},
                          float effort = 1);

/// Work of an estimator on the rays of a tile.
struct TileGather {
  /// Edges of the medium are seen by several rays (is_uneven), as those of the light behind it are.
  bool refine_medium;
  /// Adds the light of the photon map to the image, and its counts to scratch.statistics.
  std::function<void(TileScratch& scratch, const RngKey& key)> gather;
  GatherAlong gather_along;  ///< the same for a ray that goes on behind a mirror or glass
  BlurProbe* blur = nullptr; ///< takes what the fit of surfaces blurs; null: nobody asks
};

/// The light of the surfaces in the world of a pass's photons.
SurfaceLighting surface_lighting(const EstimatorInput& input, const PhotonPass& photons);

/// The camera side of a pass that gathers photons: rays and depth profiles tile by tile, direct
/// light, what is seen through the medium, and the stage times.
void shade_tiles(const EstimatorInput& input, const PhotonPass& photons, const PassSpec& spec,
                 const TileGather& tiles, PassImage& image, RenderStatistics& statistics);

} // namespace vdbeam
