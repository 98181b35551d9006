// Matt surfaces take more samples where those around are noisy, and by nothing else.
#include "shading/matt_effort.h"

#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr int width = 16;

/// A tile that shows a wall without a medium.
class Tile {
public:
  Tile() : frame_(wall_scene()) {
    const EstimatorInput input = frame_.input();
    rays_.prepare(input, {}, 0, 0);
  }

  /// The ray of a pixel.
  std::size_t ray(int x, int y) const {
    for (int i = 0; i < TileRays::count; ++i)
      if (rays_[i].pixel == static_cast<std::size_t>(y * width + x))
        return static_cast<std::size_t>(i);
    return 0;
  }
  /// Surfaces with light of 1 by shadow rays, whose samples vary by this much, and with `smooth`
  /// light, by pixel.
  template <class Smooth>
  TileSurfaces surfaces(float ray_variance, const Smooth& smooth) const {
    TileSurfaces seen;
    for (int y = 0; y < width; ++y)
      for (int x = 0; x < width; ++x) {
        SeenSurface& surface = seen[ray(x, y)];
        surface.albedo = Rgb(0.5f);
        surface.straight = {Rgb(1), -1};
        surface.smooth = {Rgb(static_cast<float>(smooth(x, y))), -1};
        surface.radiance = (surface.straight + surface.smooth) * surface.albedo;
        surface.samples = MattSamples::fewest();
        surface.straight_variance = ray_variance / 2;
        surface.surface = 0;
      }
    return seen;
  }
  std::array<MattSamples, TileRays::count> more(const TileSurfaces& seen) const {
    return more_samples(frame_.world.medium, rays_, seen, 2);
  }

private:
  static MemoryScene wall_scene() {
    MemoryScene scene;
    surfaces::add_surface(scene, SurfaceShape::quad, surfaces::scaled(20), surfaces::diffuse(0.5));
    scene.add_light(LightType::environment);
    scene.look({0, 0, 10}, {0, 0, 0}, 20, width, width);
    return scene;
  }

  TestFrame frame_;
  TileRays rays_;
};

double none(int, int) {
  return 0;
}

TEST(MattEffort, FollowsTheNoiseOfShadowRays) {
  const Tile tile;
  const std::size_t middle = tile.ray(8, 8);
  int before = -1;
  for (const float variance : {0.0f, 0.1f, 1.0f, 1e6f}) {
    const MattSamples more = tile.more(tile.surfaces(variance, none))[middle];
    EXPECT_EQ(more.paths, 0) << variance;
    EXPECT_GE(more.shadow_rays, before) << variance;
    before = more.shadow_rays;
    if (variance == 0) {
      EXPECT_EQ(more.shadow_rays, 0);
    }
  }
  EXPECT_GE(before, 8);
  EXPECT_LE(before, 16);
}

TEST(MattEffort, FollowsTheSpreadOfPaths) {
  const Tile tile;
  const auto noise = [](double size) {
    return [size](int x, int y) { return size * ((x * 7 + y * 13) % 5 == 0); };
  };
  const std::size_t middle = tile.ray(8, 8);
  EXPECT_EQ(tile.more(tile.surfaces(0, noise(0.01)))[middle].paths, 0);
  EXPECT_GT(tile.more(tile.surfaces(0, noise(100)))[middle].paths, 0);
}

TEST(MattEffort, DoesNotLookAtThePixelItself) {
  const Tile tile;
  TileSurfaces seen = tile.surfaces(0.3f, none);
  const std::size_t middle = tile.ray(8, 8), beside = tile.ray(9, 8);
  const auto before = tile.more(seen);
  seen[middle].smooth = {Rgb(1000), -1};
  seen[middle].straight = {Rgb(500), -1};
  seen[middle].straight_variance = 1e6f;
  seen[middle].radiance = {Rgb(750), -1};
  const auto after = tile.more(seen);
  EXPECT_EQ(after[middle].shadow_rays, before[middle].shadow_rays);
  EXPECT_EQ(after[middle].paths, before[middle].paths);
  // Those around do look at it.
  EXPECT_GT(after[beside].shadow_rays + after[beside].paths,
            before[beside].shadow_rays + before[beside].paths);
}

TEST(MattEffort, AsksNothingWhereNoOtherPixelShowsTheSurface) {
  const Tile tile;
  TileSurfaces seen = tile.surfaces(1, none);
  const std::size_t middle = tile.ray(8, 8);
  seen[middle].surface = 1;
  EXPECT_EQ(tile.more(seen)[middle].shadow_rays, 0);
  seen[middle].surface = -1;
  EXPECT_EQ(tile.more(seen)[middle].shadow_rays, 0);
}

} // namespace
} // namespace vdbeam
