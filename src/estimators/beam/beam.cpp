#include "estimators/beam/beam.h"

#include "estimators/beam/beam_weights.h"
#include "estimators/beam/deep_tile.h"
#include "estimators/estimator_table.h"
#include "estimators/gather/walk_pass.h"
#include "estimators/tile_shading.h"
#include "photons/blur_probe.h"

namespace vdbeam {

void BeamEstimator::render_pass(int pass, PassImage& image, RenderStatistics& statistics) {
  photons_.trace_and_build(pass, statistics);
  const World& world = photons_.world();
  const int channels = photons_.map().channels();
  const bool first_flights = photons_.map().has_first_flights();
  WeightSettings weights;
  weights.store = input_.settings.store;
  weights.albedo_in_power = photons_.plan().albedo_in_power;
  weights.colored = channels > 1;
  weights.reach = 4 * photons_.map().mean_radius();
  BlurProbe blur(input_, photons_);
  std::optional<WalkPass> walks;
  if (photons_.plan().gathers_finally(pass))
    walks.emplace(input_, photons_, pass);
  const auto gather = [&](TileScratch& scratch, const RngKey& key) {
    if (walks)
      return walks->gather(scratch, key, blur, image);
    fill_beam_tile(world, input_.camera, scratch.rays, weights, scratch.tile);
    scratch.tile.radiance.assign(static_cast<std::size_t>(channels) * BeamTile::ray_count, 0);
    scratch.tile.first_flight.assign(first_flights ? scratch.tile.radiance.size() : 0, 0);
    scratch.statistics.contributions += photons_.map().query(scratch.tile).contributions;
    const auto light_of = [&](const std::vector<float>& values, int i) {
      return channels == 1 ? Rgb(values[i])
                           : Rgb(values[i], values[BeamTile::ray_count + i],
                                 values[2 * BeamTile::ray_count + i]);
    };
    for (int i = 0; i < TileRays::count; ++i)
      if (scratch.rays[i].inside) {
        scratch.statistics.lookups += scratch.rays[i].profile.empty() ? 0 : 1;
        const std::size_t pixel = scratch.rays[i].pixel;
        image.indirect[pixel] = light_of(scratch.tile.radiance, i);
        if (first_flights)
          image.move_to_direct(pixel, light_of(scratch.tile.first_flight, i));
      }
    blur.probe(scratch.rays, scratch.tile,
               [&](int i) { return light_of(scratch.tile.radiance, i); });
    if (image.deep_layout)
      gather_pieces(world, photons_.map(), scratch.rays, scratch.tile, image);
    if (input_.layers && input_.layers->tells_volumes())
      gather_volumes(scratch, weights, image);
  };
  const auto gather_along = [&](const CameraRay& ray, const DepthProfile& profile, Rng&) {
    std::vector<float> table;
    Rgb sum;
    photons_.map().query_ray(ray_weights(world, ray, profile, weights, table), sum);
    return sum;
  };
  shade_tiles(walks ? walks->input() : input_, photons_, pass, walks.has_value(), image, statistics,
              gather, gather_along);
  if (walks)
    walks->share(blur, image);
  image.blur = blur.take();
  image.truncation = truncation(world.medium);
  photons_.release();
}

/// The same photons once more for each volume, for its layer.
void BeamEstimator::gather_volumes(TileScratch& scratch, WeightSettings weights, PassImage& image) {
  const World& world = photons_.world();
  const std::size_t volumes = world.medium.volumes.size();
  const bool grey = photons_.map().channels() == 1;
  std::vector<std::uint8_t> only(volumes);
  weights.only = &only;
  for (std::size_t v = 0; v < volumes; ++v) {
    const std::size_t setting = world.medium.volumes[v].setting;
    if (input_.layers->volume_plane(setting) < 0)
      continue;
    only.assign(volumes, 0);
    only[v] = 1;
    fill_beam_tile(world, input_.camera, scratch.rays, weights, scratch.tile);
    std::vector<float>& light = scratch.tile.radiance;
    std::fill(light.begin(), light.end(), 0.0f);
    photons_.map().query(scratch.tile);
    for (std::size_t i = 0; i < BeamTile::ray_count; ++i)
      if (const TileRays::PixelRay& ray = scratch.rays[static_cast<int>(i)]; ray.inside)
        VolumeLights(input_.layers, ray.pixel, image)
            .add(setting, grey ? Rgb(light[i])
                               : Rgb(light[i], light[BeamTile::ray_count + i],
                                     light[2 * BeamTile::ray_count + i]));
  }
}

namespace {

constexpr std::string_view beam_keys[] = {"photons",      "store",       "direct",     "kernel",
                                          "kernel_shape", "radius",      "neighbours", "min_radius",
                                          "max_radius",   "alpha",       "thinning",   "bias_rays",
                                          "forward_peak", "final_gather"};

constexpr StageSet beam_stages = {
    Stage::surfaces,          Stage::photons,           Stage::surface_photons,
    Stage::photon_importance, Stage::kernel_pilot,      Stage::map,
    Stage::neighbours,        Stage::photon_directions, Stage::photon_color,
    Stage::depth_profiles,    Stage::emission,          Stage::shadow_rays,
    Stage::spectral_tracking, Stage::beam_query,        Stage::bias};

std::unique_ptr<Estimator> make_beam(const EstimatorInput& input) {
  return std::make_unique<BeamEstimator>(input);
}

} // namespace

const EstimatorKind beam_estimator{
    .name = "beam",
    .help = "the beam radiance estimate: photons, gathered along whole camera rays",
    .unbiased = false,
    .stages = beam_stages,
    .keys = beam_keys,
    .make = make_beam};

// It reads the keys of beam, and is planned as beam; choose_estimator tells before the first pass
// which of the two renders.
const EstimatorKind auto_estimator{
    .name = "auto",
    .help = "beam, or path where a short trial tells that its error would be smaller",
    .unbiased = false,
    .stages = beam_stages,
    .keys = {},
    .make = make_beam};

} // namespace vdbeam
