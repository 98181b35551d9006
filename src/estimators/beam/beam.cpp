#include "estimators/beam/beam.h"

#include "estimators/beam/beam_ray.h"
#include "estimators/beam/deep_tile.h"
#include "estimators/estimator_table.h"
#include "photons/blur_probe.h"
#include "shading/tile_shading.h"

namespace vdbeam {

namespace {

/// The light of ray `i` of a tile; `group`: which of several such tables.
Rgb light_of(const std::vector<float>& values, int i, int channels, std::size_t group = 0) {
  const float* of_ray =
      values.data() + group * static_cast<std::size_t>(channels) * BeamTile::ray_count + i;
  return channels == 1
             ? Rgb(of_ray[0])
             : Rgb(of_ray[0], of_ray[BeamTile::ray_count], of_ray[2 * BeamTile::ray_count]);
}

} // namespace

/// Equation 11 for the rays of a tile,
///   L = sum_i K(d_i, r_i) Tr(0, t_i) sigma_s(t_i) p(w_i, -d) Phi_i / m_i:
/// the tile holds W(t) = Tr(0, t) sigma_s(t) of each ray, photons bring their power Phi_i / m_i,
/// and one query sums over all photons near the rays.
void BeamEstimator::gather(TileScratch& scratch, PassImage& image) const {
  const PhotonMap& map = photons_.map();
  BeamTile& tile = scratch.tile;
  fill_beam_tile(photons_.world(), input_.camera, scratch.rays,
                 weight_settings(photons_, input_.settings.store), tile);
  tile.by_group = map.groups() > 0;
  tile.radiance.assign(static_cast<std::size_t>(map.channels()) * BeamTile::ray_count, 0);
  tile.first_flight.assign(map.has_first_flights() ? tile.radiance.size() : 0, 0);
  scratch.statistics.contributions += map.query(tile).contributions;
  for (int i = 0; i < TileRays::count; ++i)
    if (const TileRays::PixelRay& ray = scratch.rays[i]; ray.inside) {
      scratch.statistics.lookups += ray.profile.empty() ? 0 : 1;
      std::vector<Rgb> groups;
      for (std::size_t g = 0; g < image.groups.size() && tile.by_group; ++g)
        groups.push_back(light_of(tile.group_radiance, i, map.channels(), g));
      RaySink(input_.layers, ray.pixel, image)
          .add_sum(&PassImage::indirect, {light_of(tile.radiance, i, map.channels()), groups});
      if (map.has_first_flights())
        image.move_to_direct(ray.pixel, light_of(tile.first_flight, i, map.channels()));
    }
  tile.by_group = false;
}

void BeamEstimator::render(const PassSpec& spec, PassImage& image, RenderStatistics& statistics) {
  photons_.trace_and_build(spec, KernelDomain::disc, statistics);
  BlurProbe blur(input_, photons_);
  const auto gather_tile = [&](TileScratch& scratch, const RngKey&) {
    gather(scratch, image);
    blur.probe(scratch.rays, scratch.tile, [&](int i) {
      return light_of(scratch.tile.radiance, i, photons_.map().channels());
    });
    if (image.deep_layout)
      gather_pieces(photons_.world(), photons_.map(), scratch.rays, scratch.tile, image);
    if (input_.layers && input_.layers->tells_volumes())
      gather_volumes(scratch, image);
  };
  const WeightSettings weights = weight_settings(photons_, input_.settings.store);
  const auto gather_along = [&](const CameraRay& ray, const DepthProfile& profile, Rng&) {
    return beam_radiance(photons_, photons_.map(), weights, ray, profile);
  };
  shade_tiles(input_, photons_, spec, {false, gather_tile, gather_along, &blur}, image, statistics);
  image.blur = blur.take();
  image.truncation = truncation(photons_.world().medium);
  photons_.release();
}

/// The same photons once more for each volume, for its layer.
void BeamEstimator::gather_volumes(TileScratch& scratch, PassImage& image) const {
  const auto gather_volume = [&](const WeightSettings& weights, std::size_t setting) {
    if (input_.layers->volume_plane(setting) < 0)
      return;
    fill_beam_tile(photons_.world(), input_.camera, scratch.rays, weights, scratch.tile);
    std::vector<float>& light = scratch.tile.radiance;
    std::fill(light.begin(), light.end(), 0.0f);
    photons_.map().query(scratch.tile);
    for (int i = 0; i < TileRays::count; ++i)
      if (const TileRays::PixelRay& ray = scratch.rays[i]; ray.inside)
        RaySink(input_.layers, ray.pixel, image)
            .add_of_volume(setting, light_of(light, i, photons_.map().channels()));
  };
  for_each_volume_alone(photons_, weight_settings(photons_, input_.settings.store), gather_volume);
}

namespace {

constexpr std::string_view beam_keys[] = {
    "photons",    "store",      "direct", "kernel",   "kernel_shape", "radius",      "neighbours",
    "min_radius", "max_radius", "alpha",  "thinning", "bias_rays",    "forward_peak"};

} // namespace

const EstimatorKind beam_estimator{
    .name = "beam",
    .help = "the beam radiance estimate: photons, gathered along the camera ray",
    .unbiased = false,
    .stages = gather_stages,
    .keys = beam_keys,
    .make = [](const EstimatorInput& input, PhotonPass* photons) -> std::unique_ptr<Estimator> {
      return std::make_unique<BeamEstimator>(input, *photons);
    }};

} // namespace vdbeam
