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

/// The sum of all stored powers, of one part of the medium, pass by pass.
Samples power_of(const World& world, int passes, int part = 0) {
  PhotonPassSettings settings;
  settings.paths = 4000;
  settings.skip_first_flight.assign(world.lights.size(), false);
  Samples samples;
  for (int pass = 0; pass < passes; ++pass) {
    settings.key = {1, 1, static_cast<std::uint64_t>(pass)};
    double sum = 0;
    const PhotonList photons = trace_photons(world, settings).photons;
    for (std::size_t i = 0; i < photons.size(); ++i)
      if (photons.part.empty() || photons.part[i] == part)
        sum += static_cast<double>(mean_component(photons.power[i]));
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

/// A dense ball-sized box in a layer of fog that is forty times as wide.
MemoryScene cloud_in_fog(LightType type, bool surfaces) {
  MemoryScene scene;
  VolumeSettings& cloud = scene.add_box({-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5});
  cloud.extinction = 5;
  cloud.albedo = Rgb(0.9f);
  cloud.phase = henyey_greenstein(0.5);
  VolumeSettings& fog = scene.add_box({-20, -20, 0.1}, {20, 20, 1.2}); // the cloud looks out of it
  fog.extinction = 0.1;
  fog.albedo = Rgb(0.9f);
  fog.phase = henyey_greenstein(0.7);
  LightSettings& light = scene.add_light(type);
  light.direction = {0.3, 0.2, -1};
  light.position = {1.5, 1, 3};
  light.angular_radius = 2;
  if (surfaces)
    surfaces::add_surface(scene, SurfaceShape::quad, surfaces::scaled(25), surfaces::diffuse(0.6));
  return scene;
}

class AimedAtNests : public ::testing::TestWithParam<std::tuple<LightType, bool>> {};

/// Fluence in the cloud and in the fog: whatever the aims, and whatever the fog and the ground
/// send on, the same arrives.
TEST_P(AimedAtNests, BringWhatTheyBringWithoutAims) {
  const MemoryScene scene = cloud_in_fog(std::get<0>(GetParam()), std::get<1>(GetParam()));
  const World world = scene.world(), plain = without_aims(scene);
  ASSERT_EQ(world.medium.nests.size(), 1u);
  for (const int part : {0, 1}) {
    SCOPED_TRACE(part);
    const Samples aimed = power_of(world, 100, part), without = power_of(plain, 400, part);
    expect_same_mean(aimed, without);
    expect_power(aimed, 0.02 * aimed.mean());
    expect_power(without, 0.1 * without.mean());
  }
}

/// At equal numbers of paths the cloud gets at least four times the light paths' worth.
TEST_P(AimedAtNests, FindTheCloud) {
  const MemoryScene scene = cloud_in_fog(std::get<0>(GetParam()), std::get<1>(GetParam()));
  EXPECT_LT(2 * power_of(scene.world(), 100, 0).error(),
            power_of(without_aims(scene), 100, 0).error());
}

INSTANTIATE_TEST_SUITE_P(Lights, AimedAtNests,
                         ::testing::Combine(::testing::Values(LightType::distant, LightType::point,
                                                              LightType::environment),
                                            ::testing::Bool()),
                         [](const auto& light) {
                           return std::string(std::get<0>(light.param).name) +
                                  (std::get<1>(light.param) ? "_over_ground" : "");
                         });

/// A lamp that lights the cloud as much as the sun does, which lights all of the fog, too, gets a
/// good part of the photons. By its power it would get next to none, and each would be a firefly.
TEST(LightShares, CountWhatLightsTheCloudInAWideFog) {
  MemoryScene scene = cloud_in_fog(LightType::distant, false);
  scene.add_light(LightType::point).position = {1.5, 1, 3};
  scene.scene.lights[1].intensity = Rgb(10);
  const World world = scene.world();
  const auto power = [&](std::size_t light) {
    return static_cast<double>(mean_component(world.lights[light].power()));
  };
  const std::vector<double> shares = shares_by_power(world.lights);
  EXPECT_LT(power(1), 0.1 * power(0));
  EXPECT_GT(shares[1], 0.2 * shares[0]);
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
