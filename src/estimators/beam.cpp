#include "estimators/beam.h"

#include "estimators/beam_weights.h"
#include "estimators/direct_light.h"
#include "estimators/pixel_tiles.h"

#include <tbb/combinable.h>
#include <tbb/enumerable_thread_specific.h>

#include <chrono>

namespace vdbeam {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

/// What a thread keeps from tile to tile.
struct Scratch {
  TileRays rays;
  BeamTile tile;
  RenderStatistics statistics;
};

/// Everything on a pixel's ray but the photons.
void shade_ray(const World& world, const PhotonStage& stage, const RngKey& key,
               const TileRays::PixelRay& ray, PassImage& image) {
  Rng rng(key, RngStage::direct, ray.pixel);
  Rgb tr(1);
  if (!ray.profile.empty()) {
    const Rgb tau = ray.profile.channels(world.medium, ray.profile.knots() - 1);
    tr = {std::exp(-tau.x), std::exp(-tau.y), std::exp(-tau.z)};
    image.direct[ray.pixel] = direct_light(world, ray.camera.ray, ray.profile,
                                           stage.sampled_lights(), stage.direct_samples(), rng);
    const float opacity = 1 - mean_component(tr);
    image.opacity[ray.pixel] = opacity;
    image.depth[ray.pixel] = static_cast<float>(
        (ray.profile.opacity_depth() + ray.camera.shift * opacity) / world.space.scale);
  }
  image.background[ray.pixel] = tr * world.lights.escaped_radiance(Vec3f(ray.direction));
}

} // namespace

void BeamEstimator::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  const World& world = input_.world;
  const Camera& camera = input_.camera;
  stage_.shoot(pass, statistics);
  image.resize(camera.width(), camera.height());
  const RngKey key{world.settings.seed, input_.frame, static_cast<std::uint64_t>(pass)};
  const int channels = stage_.map().channels();
  WeightSettings weights;
  weights.store = world.settings.store;
  weights.albedo_in_power =
      stage_.albedo_in_power() || world.settings.store == PhotonStore::scatter;
  weights.reach = 4 * stage_.map().mean_radius();
  tbb::enumerable_thread_specific<Scratch> scratches;
  for_each_tile(camera.width(), camera.height(), [&](int x0, int y0, int, int) {
    Scratch& scratch = scratches.local();
    const Clock::time_point start = Clock::now();
    scratch.rays.prepare(world, camera, key, x0, y0);
    fill_beam_tile(world, camera, scratch.rays, weights, scratch.tile);
    const Clock::time_point profiled = Clock::now();
    for (int i = 0; i < TileRays::count; ++i)
      if (scratch.rays[i].inside)
        shade_ray(world, stage_, key, scratch.rays[i], image);
    const Clock::time_point shaded = Clock::now();
    scratch.tile.radiance.assign(static_cast<std::size_t>(channels) * BeamTile::ray_count, 0);
    if (stage_.map().size() > 0)
      scratch.statistics.contributions += stage_.map().query(scratch.tile).contributions;
    const float* radiance = scratch.tile.radiance.data();
    for (int i = 0; i < TileRays::count; ++i)
      if (scratch.rays[i].inside)
        image.indirect[scratch.rays[i].pixel] =
            channels == 1 ? Rgb(radiance[i])
                          : Rgb(radiance[i], radiance[256 + i], radiance[512 + i]);
    const Clock::time_point queried = Clock::now();
    scratch.statistics.profile += seconds_between(start, profiled);
    scratch.statistics.direct += seconds_between(profiled, shaded);
    scratch.statistics.query += seconds_between(shaded, queried);
  });
  // Stage seconds are processor seconds of the tiles, shared out over the threads that worked.
  const double threads = static_cast<double>(std::max<std::size_t>(1, scratches.size()));
  for (const Scratch& scratch : scratches) {
    statistics.profile += scratch.statistics.profile / threads;
    statistics.direct += scratch.statistics.direct / threads;
    statistics.query += scratch.statistics.query / threads;
    statistics.contributions += scratch.statistics.contributions;
  }
  statistics.camera_rays += static_cast<std::uint64_t>(image.width) * image.height;
}

} // namespace vdbeam
