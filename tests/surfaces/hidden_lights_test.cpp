// Lights that shadow rays do not reach are left to photons.
#include "photons/hidden_lights.h"

#include "support/surface_test.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// Fog about a lamp in a bulb of glass.
MemoryScene lamp_in_a_bulb() {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = 0.7;
  box.albedo = Rgb(0.9f);
  scene.look({0, 0.3, 4}, {0, 0, 0}, 34, 16, 16);
  add_surface(scene, SurfaceShape::sphere, scaled(0.3), glass());
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {0.05, 0, 0}), shining(20));
  return scene;
}

std::vector<bool> in_sight(const MemoryScene& scene) {
  const test::TestFrame frame(scene);
  return lights_in_sight(frame.input(), frame.input().shadow_ray_lights());
}

TEST(HiddenLights, AreThoseThatNoShadowRayReaches) {
  MemoryScene scene = lamp_in_a_bulb();
  EXPECT_EQ(in_sight(scene), std::vector<bool>{false});
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.01), {0.7, 0.7, 0}), shining(20));
  EXPECT_EQ(in_sight(scene), (std::vector<bool>{false, true}));
}

/// Fog, and a lamp behind a slit in a wall.
MemoryScene lamp_behind_a_slit(double half_slit) {
  MemoryScene scene;
  scene.add_box({0, -1, -1}, {1, 1, 1});
  scene.look({0.5, 0.3, 4}, {0.5, 0, 0}, 34, 16, 16);
  for (const double side : {-1, 1}) {
    SurfaceSettings& wall = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.5));
    wall.transform = {0, 0, 1, -0.2, 0, 1, 0, side * (1 + half_slit), -1, 0, 0, 0};
  }
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.01), {-0.5, 0, 0}), shining(20));
  return scene;
}

/// Through the slit a point of the fog in a hundred or so sees the lamp.
TEST(HiddenLights, AreNotThoseBehindASlit) {
  for (const double half_slit : {0.005, -0.005})
    EXPECT_EQ(in_sight(lamp_behind_a_slit(half_slit)), std::vector<bool>{half_slit > 0});
}

/// Or it would depend on which of them another thread has found.
TEST(HiddenLights, AreFoundWhateverOtherLightsThereAre) {
  int found = 0;
  constexpr int seeds = 24;
  for (int seed = 1; seed <= seeds; ++seed) {
    // So thin a slit that chance decides.
    MemoryScene scene = lamp_behind_a_slit(0.00003);
    scene.scene.render.seed = static_cast<std::uint64_t>(seed);
    const bool alone = in_sight(scene)[0];
    // A lamp in a shell, which is never found, and one in the open, which is found at once.
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.02), {-0.8, 0, 0}), diffuse(0.5));
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.01), {-0.8, 0, 0}), shining(20));
    EXPECT_EQ(in_sight(scene), (std::vector<bool>{alone, false})) << seed;
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.01), {0.7, 0.7, 0}), shining(20));
    EXPECT_EQ(in_sight(scene), (std::vector<bool>{alone, false, true})) << seed;
    found += alone;
  }
  EXPECT_GT(found, 2);
  EXPECT_LT(found, seeds - 2);
}

class HiddenLightsOf : public ::testing::TestWithParam<EstimatorType> {};

/// The light is the same, without any shadow ray in the fog.
TEST_P(HiddenLightsOf, CostNoShadowRays) {
  const MemoryScene scene = lamp_in_a_bulb();
  const PassMeans path = render_passes(scene, EstimatorType::path, 96);
  const PassMeans mine = render_passes(scene, GetParam(), 48);
  EXPECT_EQ(mine.statistics.shadow_rays, 0);
  EXPECT_GT(path.direct[0].mean(), 1e-3);
  EXPECT_EQ(regions_apart(mine, path, 0.03), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

INSTANTIATE_TEST_SUITE_P(Surfaces, HiddenLightsOf,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
