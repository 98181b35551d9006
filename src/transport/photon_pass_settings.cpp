#include "transport/photon_tracing.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

std::vector<std::uint64_t> share_paths(const LightSet& lights, std::uint64_t paths,
                                       const PathGuide* guide) {
  std::vector<double> power(lights.size());
  double total = 0;
  for (std::size_t i = 0; i < lights.size(); ++i)
    total += power[i] = guide ? guide->light_shares[i] : mean_component(Vec3d(lights[i].power()));
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
