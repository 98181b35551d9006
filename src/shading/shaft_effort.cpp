#include "shading/shaft_effort.h"

#include "medium/depth_profile.h"
#include "rays/shaft_light.h"

#include <algorithm>

namespace vdbeam {

std::array<float, TileRays::count> shaft_effort(const World& world,
                                                const std::vector<bool>& sampled,
                                                const TileRays& rays, const TileSurfaces& seen,
                                                const RngKey& key) {
  std::array<float, TileRays::count> efforts;
  efforts.fill(1);
  if (std::find(sampled.begin(), sampled.end(), true) == sampled.end())
    return efforts;
  std::array<ShaftLight, TileRays::count> shafts;
  for (int i = 0; i < TileRays::count; ++i)
    if (rays[i].inside) {
      Rng rng(key, RngStage::shaft_light, rays[i].stream);
      shafts[static_cast<std::size_t>(i)] =
          look_for_shafts(world, rays[i].camera.ray(), rays[i].profile, sampled, rng);
    }
  for (int i = 0; i < TileRays::count; ++i) {
    const auto center = static_cast<std::size_t>(i);
    if (!(shafts[center].rays > 0))
      continue;
    ShaftLight near;
    for_each_near(seen, i, [&](int other) { near += shafts[static_cast<std::size_t>(other)]; });
    const Rgb tr = transmittance(world.medium, rays[i].profile);
    efforts[center] = near.effort(mean_component(seen[center].radiance.sum() * tr));
  }
  return efforts;
}

} // namespace vdbeam
