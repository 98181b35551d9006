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

Rgb BlurProbe::compared(const TileRays::PixelRay& ray, const BeamTile& tile, int index) const {
  const BeamTile::Profile& knots = tile.profiles[index / BeamTile::rays_per_subtile];
  if (knots.knots == 0 || ray.profile.empty())
    return {};
  // The ray's column of its sub-tile's table.
  const std::size_t lane = static_cast<std::size_t>(index % BeamTile::rays_per_subtile);
  std::vector<float> weights(tile.phases->size() * static_cast<std::size_t>(tile.weight_channels) *
                             static_cast<std::size_t>(knots.knots));
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[k] = tile.weights[knots.offset + k * BeamTile::rays_per_subtile + lane];
  PhotonMap::RayProfile profile;
  profile.ray = ray.camera.ray();
  const double shift = tile.shift[static_cast<std::size_t>(index)];
  profile.t_begin = static_cast<float>(knots.t_begin - shift);
  profile.step = knots.step;
  profile.knots = knots.knots;
  profile.t_end = static_cast<float>(tile.end[static_cast<std::size_t>(index)] - shift);
  profile.weights = weights.data();
  profile.weight_channels = tile.weight_channels;
  profile.phases = tile.phases;
  Rgb radiance;
  map_.query_ray(profile, radiance);
  return map_.channels() == 1 && tile.weight_channels == 1 ? Rgb(radiance.x) : radiance;
}

} // namespace vdbeam
