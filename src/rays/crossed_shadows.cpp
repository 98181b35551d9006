#include "rays/crossed_shadows.h"

#include "medium/distance_sampling.h"

#include <array>

namespace vdbeam {

bool crosses_shadows(const World& world, const Ray& ray, const DepthProfile& profile,
                     const std::vector<bool>& sampled, Rng& rng) {
  constexpr int points = 4;
  if (!world.surfaces || profile.empty())
    return false;
  DistanceSampler distances(world.medium, ray, profile);
  if (!(distances.opacity(0) > 0))
    return false;
  std::array<Vec3f, points> along;
  for (int i = 0; i < points; ++i) {
    const float u = (static_cast<float>(i) + rng.uniform()) / points;
    along[static_cast<std::size_t>(i)] = distances.sample(u, 0).position;
  }
  for (std::size_t l = 0; l < world.lights.size(); ++l) {
    if (!sampled[l])
      continue;
    bool lit = false, dark = false;
    for (const Vec3f& point : along) {
      const float u = rng.uniform(), v = rng.uniform();
      const IncidentSample light = world.lights[l].sample_incident(point, u, v);
      if (!(max_component(light.value) > 0))
        continue;
      const bool seen = unoccluded(world, Vec3d(point), light.wi, light.distance);
      (seen ? lit : dark) = true;
      if (lit && dark)
        return true;
    }
  }
  return false;
}

} // namespace vdbeam
