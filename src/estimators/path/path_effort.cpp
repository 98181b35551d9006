#include "estimators/path/path_effort.h"

#include "tuning/constants.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

PartDraws PathEffort::draws_of(PathPart part, float share, float u) const {
  // What lies behind a dense cloud is not worth a draw in every pass.
  constexpr float least_share = 1e-6f;
  if (share < least_share) {
    const float chance = share / least_share;
    return u < chance ? PartDraws{1, 1 / chance} : PartDraws{};
  }
  const float expected = draws[static_cast<std::size_t>(part)] * share;
  const int count = std::max(1, static_cast<int>(std::lround(expected)));
  return {count, 1 / static_cast<float>(count)};
}

PathTrial& PathTrial::operator+=(const PathTrial& other) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i].variance += other.parts[i].variance;
    parts[i].time += other.parts[i].time;
  }
  ray_variance += other.ray_variance;
  ray_time += other.ray_time;
  return *this;
}

PathEffort PathTrial::best_effort(double least_time) const {
  // A few rays do not show how little the variance is that draws do not change.
  double of_draws = 0;
  for (const Part& part : parts)
    of_draws += part.variance;
  const double of_rays = std::max(ray_variance, tuning::least_share_of_rays * of_draws);
  PathEffort effort;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!(parts[i].time > 0)) {
      effort.draws[i] = 1; // it adds nothing to any ray
      continue;
    }
    const double in_time = ray_time / parts[i].time;
    const double square = of_rays > 0 ? in_time * parts[i].variance / of_rays : 0;
    const double best = std::max(std::sqrt(square), least_time * in_time);
    effort.draws[i] = static_cast<float>(std::clamp(best, 1.0, double{PathEffort::most}));
  }
  return effort;
}

double time_of_shadow_ray(const Medium& medium) {
  const bool has_voxels = std::any_of(medium.volumes.begin(), medium.volumes.end(),
                                      [](const Volume& volume) { return !volume.field.layers(); });
  return has_voxels ? tuning::time_of_ray_in_voxels : tuning::time_of_ray_in_layers;
}

double time_of_paths(const Medium& medium, const RenderStatistics& counts) {
  return time_of_shadow_ray(medium) * static_cast<double>(counts.shadow_rays) +
         tuning::time_of_walk * static_cast<double>(counts.camera_walks) +
         tuning::time_of_walk_collision * static_cast<double>(counts.walk_collisions) +
         tuning::time_of_walk_shadow_ray * static_cast<double>(counts.walk_shadow_rays);
}

} // namespace vdbeam
