#include "estimators/beam.h"

#include "estimators/beam_weights.h"
#include "estimators/tile_shading.h"

namespace vdbeam {

void BeamEstimator::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  photons_.trace_and_build(pass, statistics);
  const World& world = photons_.world();
  const int channels = photons_.map().channels();
  WeightSettings weights;
  weights.store = world.settings.store;
  weights.albedo_in_power = photons_.plan().albedo_in_power;
  weights.reach = 4 * photons_.map().mean_radius();
  shade_tiles(input_, photons_, pass, image, statistics, [&](TileScratch& scratch, const RngKey&) {
    fill_beam_tile(world, input_.camera, scratch.rays, weights, scratch.tile);
    scratch.tile.radiance.assign(static_cast<std::size_t>(channels) * BeamTile::ray_count, 0);
    scratch.statistics.contributions += photons_.map().query(scratch.tile).contributions;
    const float* radiance = scratch.tile.radiance.data();
    for (int i = 0; i < TileRays::count; ++i)
      if (scratch.rays[i].inside) {
        scratch.statistics.lookups += scratch.rays[i].profile.empty() ? 0 : 1;
        image.indirect[scratch.rays[i].pixel] =
            channels == 1 ? Rgb(radiance[i])
                          : Rgb(radiance[i], radiance[256 + i], radiance[512 + i]);
      }
  });
}

} // namespace vdbeam
