#include "estimators/tile_shading.h"

#include "estimators/direct_light.h"
#include "estimators/pixel_tiles.h"
#include "estimators/profile_shading.h"

#include <tbb/enumerable_thread_specific.h>

#include <chrono>

namespace vdbeam {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

} // namespace

void shade_tiles(const EstimatorInput& input, const PhotonPass& photons, int pass, PassImage& image,
                 RenderStatistics& statistics,
                 const std::function<void(TileScratch& scratch, const RngKey& key)>& gather) {
  const World& world = input.world;
  const Camera& camera = input.camera;
  image.resize(camera.width(), camera.height(), !world.medium.emitters.empty());
  const RngKey key{world.settings.seed, input.frame, static_cast<std::uint64_t>(pass)};
  const auto shade_ray = [&](const TileRays::PixelRay& ray, RenderStatistics& counts) {
    counts.depth_profiles += ray.profile.empty() ? 0 : 1;
    shade_profile(world, ray.camera, ray.profile, ray.pixel, image, counts.emission_rays);
    Rng rng(key, RngStage::direct, ray.pixel);
    image.direct[ray.pixel] =
        direct_light(world, ray.camera.ray(), ray.profile, photons.plan().sampled_lights,
                     photons.plan().direct_samples, rng, counts.shadow_rays);
  };
  tbb::enumerable_thread_specific<TileScratch> scratches;
  for_each_tile(input, [&](int x0, int y0, int, int) {
    TileScratch& scratch = scratches.local();
    const Clock::time_point start = Clock::now();
    scratch.rays.prepare(world, camera, key, x0, y0);
    const Clock::time_point profiled = Clock::now();
    for (int i = 0; i < TileRays::count; ++i)
      if (scratch.rays[i].inside)
        shade_ray(scratch.rays[i], scratch.statistics);
    const Clock::time_point shaded = Clock::now();
    if (photons.map().size() > 0)
      gather(scratch, key);
    scratch.statistics.profile += seconds_between(start, profiled);
    scratch.statistics.direct += seconds_between(profiled, shaded);
    scratch.statistics.query += seconds_between(shaded, Clock::now());
  });
  // Stage seconds are processor seconds of the tiles, shared out over the threads that worked.
  const double threads = static_cast<double>(std::max<std::size_t>(1, scratches.size()));
  for (const TileScratch& scratch : scratches) {
    statistics.profile += scratch.statistics.profile / threads;
    statistics.direct += scratch.statistics.direct / threads;
    statistics.query += scratch.statistics.query / threads;
    statistics.contributions += scratch.statistics.contributions;
    statistics.lookups += scratch.statistics.lookups;
    statistics.depth_profiles += scratch.statistics.depth_profiles;
    statistics.shadow_rays += scratch.statistics.shadow_rays;
    statistics.emission_rays += scratch.statistics.emission_rays;
  }
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
}

} // namespace vdbeam
