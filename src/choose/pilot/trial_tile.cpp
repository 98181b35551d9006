#include "choose/pilot/trial_tile.h"

#include "estimators/beam/beam_weights.h"
#include "rays/direct_light.h"
#include "rays/pixel_tiles.h"
#include "rays/profile_shading.h"
#include "tuning/constants.h"
#include "walks/walk_tracer.h"

#include <cmath>

namespace vdbeam {

namespace {

/// Gathers the tile's rays from each map.
std::vector<std::vector<float>> gather(const EstimatorInput& input,
                                       const std::vector<PhotonMap>& maps, BeamTile& tile) {
  std::vector<std::vector<float>> pictures;
  for (const PhotonMap& map : maps) {
    tile.radiance.assign(static_cast<std::size_t>(map.channels()) * BeamTile::ray_count, 0);
    if (!input.stopped())
      map.query(tile);
    pictures.push_back(tile.radiance);
  }
  return pictures;
}

} // namespace

TileRays::PixelRay trial_ray(const EstimatorInput& input, const RngKey& key, std::size_t pixel) {
  const auto width = static_cast<std::size_t>(input.camera.width());
  TileRays::PixelRay ray = TileRays::pixel_ray(input, key, static_cast<int>(pixel % width),
                                               static_cast<int>(pixel / width));
  ray.profile.build(input.world.medium, ray.camera.segment,
                    static_cast<float>(input.settings.cutoff), ray.camera.air);
  return ray;
}

std::vector<TilePlace> choose_trial_tiles(const Camera& camera) {
  const int columns = (camera.width() + tile_width - 1) / tile_width;
  const int rows = (camera.height() + tile_width - 1) / tile_width;
  const std::int64_t all = static_cast<std::int64_t>(columns) * rows;
  const std::int64_t count = std::min<std::int64_t>(all, tuning::trial_tiles);
  // Steps along the rows of tiles; the additive recurrence keeps them from lining up in columns.
  std::vector<TilePlace> tiles;
  for (std::int64_t i = 0; i < count; ++i) {
    const double shift = 0.6180339887498949 * static_cast<double>(i);
    const double place = (static_cast<double>(i) + shift - std::floor(shift)) *
                         static_cast<double>(all) / static_cast<double>(count);
    const auto tile = static_cast<int>(std::min(static_cast<std::int64_t>(place), all - 1));
    tiles.push_back({tile % columns * tile_width, tile / columns * tile_width});
  }
  return tiles;
}

SeenMedium TrialTile::seen() const {
  return {place.x0, place.y0, tile_width, tile_width, opacity.data(), depth.data()};
}

TrialTile view_trial_tile(const EstimatorInput& input, const PhotonPlan& plan,
                          const TilePlace& place, const std::vector<PhotonMap>& narrow,
                          const std::vector<PhotonMap>& wide, const RngKey& key) {
  const World& world = input.world;
  TileRays rays;
  rays.prepare(input, key, place.x0, place.y0);
  WeightSettings weights;
  weights.store = input.settings.store;
  weights.albedo_in_power = plan.albedo_in_power;
  weights.colored = input.photon_channels() > 1;
  BeamTile tile;
  fill_beam_tile(world, input.camera, rays, weights, tile);
  const WalkTracer surfaces(world, lights_of_surfaces(input), input.settings.max_bounces);
  TrialTile view;
  view.place = place;
  view.narrow = gather(input, narrow, tile);
  view.wide = gather(input, wide, tile);
  PassImage beside;
  beside.resize(TileRays::count, 1, !world.medium.emitters.empty());
  std::uint64_t shadow_rays = 0, emission_rays = 0;
  const std::size_t channels = view.wide[0].size() / TileRays::count;
  const auto width = static_cast<std::size_t>(input.camera.width());
  for (std::size_t i = 0; i < TileRays::count; ++i) {
    const TileRays::PixelRay& ray = rays[static_cast<int>(i)];
    if (!ray.inside || ray.profile.empty() || input.stopped() ||
        ray.profile.opacity() < plan.full_opacity) // hardly seen
      continue;
    CameraRay without_surface = ray.camera;
    without_surface.hit.reset();
    shade_profile(input, without_surface, ray.profile, i, beside);
    shade_emission(input, world, ray.camera, ray.profile, i, beside, emission_rays);
    // Also of lights that the camera does not see: hiding a sky must change no other pixel's plan.
    const Rgb tr = transmittance(world.medium, ray.profile);
    beside.background[i] = lights_through(world, ray.camera.whole(), ray.profile, tr, false).sum();
    if (ray.camera.hit) {
      Rng rng(key, RngStage::surface, ray.pixel);
      beside.background[i] +=
          tr * surfaces.from_surface(*ray.camera.hit, ray.camera.ray().direction, rng).sum();
    }
    const std::size_t x = ray.pixel % width - static_cast<std::size_t>(place.x0);
    const std::size_t y = ray.pixel / width - static_cast<std::size_t>(place.y0);
    view.ray_of[y * tile_width + x] = i;
    view.opacity[y * tile_width + x] = beside.opacity[i];
    view.depth[y * tile_width + x] = beside.depth[i];
    // One sample is enough, since it only enters the pixel's weight.
    Rng rng(key, RngStage::direct, ray.pixel);
    const Rgb known = beside.total(i) + direct_light(world, ray.camera.ray(), ray.profile,
                                                     {plan.sampled_lights}, rng, shadow_rays)
                                            .sum();
    view.pixels.push_back(ray.pixel);
    view.rays.push_back(i);
    for (std::size_t c = 0; c < channels; ++c) {
      view.places.push_back(c * TileRays::count + i);
      view.known.push_back(
          static_cast<double>(channels == 1 ? mean_component(known) : known[static_cast<int>(c)]));
      view.brightness += view.known.back() + Spread(view.wide, view.places.back()).mean;
    }
  }
  return view;
}

Spread::Spread(const std::vector<std::vector<float>>& pictures, std::size_t place) {
  const auto count = static_cast<double>(pictures.size());
  for (const auto& picture : pictures)
    mean += static_cast<double>(picture[place]) / count;
  for (const auto& picture : pictures) {
    const double d = static_cast<double>(picture[place]) - mean;
    squares += d * d;
  }
}

} // namespace vdbeam
