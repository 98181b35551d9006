#include "estimators/shaft_effort.h"

#include "medium/depth_profile.h"
#include "rays/shaft_light.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// Pixels to each side that count.
constexpr int reach = 2;

} // namespace

std::array<float, TileRays::count> shaft_effort(const World& world,
                                                const std::vector<bool>& sampled,
                                                const TileRays& rays, const TileSurfaces& seen,
                                                const RngKey& key) {
  constexpr int width = TileRays::across;
  std::array<ShaftLight, TileRays::count> shafts;
  for (int i = 0; i < TileRays::count; ++i)
    if (rays[i].inside) {
      Rng rng(key, RngStage::shaft_light, rays[i].stream);
      shafts[static_cast<std::size_t>(i)] =
          look_for_shafts(world, rays[i].camera.ray(), rays[i].profile, sampled, rng);
    }
  std::array<float, TileRays::count> efforts;
  efforts.fill(1);
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) {
      const auto center = static_cast<std::size_t>(TileRays::ray_at(x, y));
      if (!(shafts[center].rays > 0))
        continue;
      ShaftLight around;
      for (int py = std::max(0, y - reach); py <= std::min(width - 1, y + reach); ++py)
        for (int px = std::max(0, x - reach); px <= std::min(width - 1, x + reach); ++px) {
          const auto other = static_cast<std::size_t>(TileRays::ray_at(px, py));
          if (seen[other].surface == seen[center].surface)
            around += shafts[other];
        }
      const Rgb tr = transmittance(world.medium, rays[static_cast<int>(center)].profile);
      efforts[center] = around.effort(mean_component(seen[center].radiance.sum() * tr));
    }
  return efforts;
}

} // namespace vdbeam
