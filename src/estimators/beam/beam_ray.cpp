#include "estimators/beam/beam_ray.h"

namespace vdbeam {

WeightSettings weight_settings(const PhotonPass& photons, PhotonStore store) {
  WeightSettings weights;
  weights.store = store;
  weights.albedo_in_power = photons.plan().albedo_in_power;
  weights.colored = photons.map().channels() > 1;
  weights.reach = 4 * photons.map().mean_radius();
  return weights;
}

GroupedLight beam_radiance(const PhotonPass& photons, const PhotonMap& map,
                           const WeightSettings& weights, const CameraRay& ray,
                           const DepthProfile& profile) {
  std::vector<float> table;
  std::vector<Rgb> groups;
  Rgb sum;
  map.query_ray(ray_weights(photons.world(), ray, profile, weights, table), sum,
                map.groups() > 0 ? &groups : nullptr);
  return {sum, groups};
}

} // namespace vdbeam
