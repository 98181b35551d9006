#include "photons/blur_probe.h"

#include <algorithm>

namespace vdbeam {

BlurProbe::BlurProbe(const EstimatorInput& input, const PhotonPass& photons)
    : map_(photons.compared_map()) {
  for (std::size_t i = 0; input.blur_pixels && i < input.blur_pixels->size(); ++i)
    values_.push_back({(*input.blur_pixels)[i], {}});
}

PixelValue* BlurProbe::find(std::size_t pixel) {
  const auto found = std::lower_bound(
      values_.begin(), values_.end(), pixel,
      [](const PixelValue& value, std::size_t wanted) { return value.pixel < wanted; });
  return found != values_.end() && found->pixel == pixel ? &*found : nullptr;
}

Rgb BlurProbe::compared(const TileRays::PixelRay& ray, BeamTile& tile, int index) const {
  if (ray.profile.empty())
    return {};
  const std::size_t lane = static_cast<std::size_t>(index % BeamTile::rays_per_subtile);
  const double shift = tile.shift[static_cast<std::size_t>(index)];
  std::vector<std::vector<float>> weights(tile.part_count());
  std::vector<PhotonMap::RayProfile> by_part(tile.part_count());
  for (std::size_t part = 0; part < by_part.size(); ++part) {
    tile.choose_part(part);
    const BeamTile::Profile& knots = tile.profiles[index / BeamTile::rays_per_subtile];
    // The ray's column of its sub-tile's table.
    weights[part].resize(tile.rows() * static_cast<std::size_t>(knots.knots));
    for (std::size_t k = 0; k < weights[part].size(); ++k)
      weights[part][k] = tile.weights[knots.offset + k * BeamTile::rays_per_subtile + lane];
    PhotonMap::RayProfile& profile = by_part[part];
    profile.ray = ray.camera.ray();
    profile.t_begin = static_cast<float>(knots.t_begin - shift);
    profile.step = knots.step;
    profile.knots = knots.knots;
    profile.t_end = static_cast<float>(tile.end[static_cast<std::size_t>(index)] - shift);
    profile.weights = weights[part].data();
    profile.weight_channels = tile.weight_channels;
    profile.phases = tile.phases;
  }
  Rgb radiance;
  map_.query_ray(by_part, radiance);
  return map_.channels() == 1 && tile.weight_channels == 1 ? Rgb(radiance.x) : radiance;
}

} // namespace vdbeam
