// Photons that are aimed at several targets bring what they would bring without aims.
#include "transport/photon_targets.h"

#include "lights/surface_light.h"
#include "support/memory_scene.h"
#include "support/statistics.h"
#include "support/surface_scene.h"
#include "transport/photon_tracing.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

/// A box of fog over a ground, beside a roof that shades a part of it.
MemoryScene scene_of(LightType type, double ground) {
  MemoryScene scene;
  VolumeSettings& fog = scene.add_box({-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5});
  fog.extinction = 3;
  fog.albedo = Rgb(0.8f);
  LightSettings& light = scene.add_light(type);
  light.direction = {0.3, 0.2, -1};
  light.position = {1.5, 1, 4};
  light.cone_angle = 60;
  light.angular_radius = 2;
  surfaces::add_surface(scene, SurfaceShape::quad, surfaces::scaled(ground),
                        surfaces::diffuse(0.6));
  surfaces::add_surface(scene, SurfaceShape::quad,
                        surfaces::moved(surfaces::scaled(0.4), {0.3, -0.3, 2}),
                        surfaces::diffuse(0.3));
  return scene;
}

/// The sum of all stored powers, pass by pass.
Samples power_of(const World& world, int passes) {
  PhotonPassSettings settings;
  settings.paths = 4000;
  settings.skip_first_flight.assign(world.lights.size(), false);
  Samples samples;
  for (int pass = 0; pass < passes; ++pass) {
    settings.key = {1, 1, static_cast<std::uint64_t>(pass)};
    double sum = 0;
    for (const Rgb& power : trace_photons(world, settings).photons.power)
      sum += static_cast<double>(mean_component(power));
    samples.add(sum);
  }
  return samples;
}

/// The same world, its lights aimed at the bounds of everything, by one strategy.
World without_aims(const MemoryScene& scene) {
  World world = scene.world();
  const OccupiedRegion& all = world.targets.back();
  world.lights = LightSet(scene.scene.lights, scene.scene.camera.up, world.space, all);
  return world;
}

class AimedLights : public ::testing::TestWithParam<LightType> {};

TEST_P(AimedLights, BringWhatTheyBringWithoutAims) {
  const MemoryScene scene = scene_of(GetParam(), 3);
  const World world = scene.world();
  ASSERT_GE(world.targets.size(), 2u);
  const Samples aimed = power_of(world, 100), plain = power_of(without_aims(scene), 400);
  expect_same_mean(aimed, plain);
  expect_power(aimed, 0.01 * aimed.mean());
  expect_power(plain, 0.02 * plain.mean());
}

/// Over a ground a thousand times as wide as the medium about the same light arrives, with little
/// more noise than over one that is forty times as wide. What the far ground adds is what fills the
/// last 3 degrees below the horizon.
TEST_P(AimedLights, DoNotNoticeTheWidthOfTheGround) {
  const Samples narrow = power_of(scene_of(GetParam(), 20).world(), 100);
  const Samples wide = power_of(scene_of(GetParam(), 500).world(), 100);
  expect_same_mean(narrow, wide, 0.05 * narrow.mean());
  EXPECT_LT(wide.error(), 2 * narrow.error());
}

INSTANTIATE_TEST_SUITE_P(Lights, AimedLights,
                         ::testing::Values(LightType::distant, LightType::point, LightType::spot,
                                           LightType::environment, LightType::sky),
                         [](const auto& light) { return std::string(light.param.name); });

/// A lamp among the surfaces, aimed at the medium and at the rest.
TEST(AimedLamp, BringsWhatItBringsWithoutAims) {
  MemoryScene scene = scene_of(LightType::distant, 3);
  scene.scene.lights.clear();
  surfaces::add_surface(scene, SurfaceShape::disk,
                        surfaces::moved(surfaces::scaled(0.3), {-1.5, 1, 3}, true),
                        surfaces::shining(2));
  const World world = scene.world();
  World plain = world;
  plain.lights = {};
  plain.lights.add(std::make_unique<SurfaceLight>(world.surfaces->set, 2, Rgb(2), false));
  const Samples aimed = power_of(world, 100), without = power_of(plain, 400);
  expect_same_mean(aimed, without);
  EXPECT_LT(aimed.error() * 1.5, without.error());
}

TEST(PhotonTargets, LieOneWithinTheOther) {
  const World world = scene_of(LightType::distant, 1000).world();
  ASSERT_GE(world.targets.size(), 4u);
  for (std::size_t i = 1; i < world.targets.size(); ++i) {
    EXPECT_GT(world.targets[i].radius, world.targets[i - 1].radius);
    EXPECT_LE(length(world.targets[i].center - world.targets[i - 1].center),
              world.targets[i].radius);
  }
}

} // namespace
} // namespace vdbeam
