#include "transport/photon_tracing.h"

#include <algorithm>
#include <cmath>

#include <numeric>

namespace vdbeam {

std::vector<double> shares_by_power(const LightSet& lights) {
  std::vector<double> power, into_nest;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    power.push_back(mean_component(Vec3d(lights[i].power())));
    into_nest.push_back(mean_component(Vec3d(lights[i].power_into_nest())));
  }
  const double all = std::accumulate(power.begin(), power.end(), 0.0),
               nest = std::accumulate(into_nest.begin(), into_nest.end(), 0.0);
  if (into_nest == power || !(nest > 0))
    return power;
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] = 0.5 * (power[i] / all + into_nest[i] / nest);
  return power;
}

std::vector<std::uint64_t> share_paths(const LightSet& lights, std::uint64_t paths,
                                       const PathGuide* guide) {
  const std::vector<double> power = guide ? guide->light_shares : shares_by_power(lights);
  const double total = std::accumulate(power.begin(), power.end(), 0.0);
  std::vector<std::uint64_t> first{0};
  double sum = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    sum += power[i];
    std::uint64_t end =
        total > 0
            ? static_cast<std::uint64_t>(std::llround(sum / total * static_cast<double>(paths)))
            : 0;
    if (power[i] > 0) // no light is left out altogether
      end = std::max(end, first.back() + 1);
    first.push_back(end);
  }
  return first;
}

bool same_photons(const PhotonPassSettings& a, const PhotonPassSettings& b) {
  // Names every member, so that a new one cannot be forgotten here.
  const auto& [paths, store, store_probability, store_probability_by_cell, camera, truncation_order,
               skip_first_flight, max_bounces, surface_photon_lights, caustic_lights, directions,
               albedo, guide, path_numbers, key, stop] = a;
  static_cast<void>(stop);
  const bool same_cells = store_probability_by_cell == b.store_probability_by_cell ||
                          (store_probability_by_cell && b.store_probability_by_cell &&
                           *store_probability_by_cell == *b.store_probability_by_cell);
  const bool same_guide = guide == b.guide || (guide && b.guide && *guide == *b.guide);
  return camera == b.camera && same_cells && same_guide && path_numbers == b.path_numbers &&
         paths == b.paths && surface_photon_lights == b.surface_photon_lights &&
         caustic_lights == b.caustic_lights && store == b.store &&
         store_probability == b.store_probability && truncation_order == b.truncation_order &&
         skip_first_flight == b.skip_first_flight && max_bounces == b.max_bounces &&
         directions == b.directions && albedo == b.albedo && key == b.key;
}

} // namespace vdbeam
