#include "photons/photon_plan.h"

#include "choose/choose.h"
#include "support/render_passes.h"
#include "tuning/constants.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

TEST(PhotonPlan, ThinRaysTakeMoreShadowRays) {
  PhotonPlan plan;
  plan.most_direct_samples = 6;
  EXPECT_EQ(plan.direct_samples_of(0), 6);
  EXPECT_EQ(plan.direct_samples_of(3), 3);
  EXPECT_EQ(plan.direct_samples_of(30), 2);
  plan.direct_samples = plan.most_direct_samples = 1; // the user's own number
  EXPECT_EQ(plan.direct_samples_of(0), 1);
  EXPECT_EQ(plan.direct_samples_of(30), 1);
}

TEST(PhotonPlan, ThinMediaTakeMoreLightPaths) {
  const double usual = automatic_paths(1e4, 3, 3);
  EXPECT_EQ(automatic_paths(1e4, 1, 1), usual);
  // Three paths for the collisions that two of them would bring, to the nearest step of 2^(1/4).
  EXPECT_NEAR(automatic_paths(1e4, 2.0 / 3, 2.0 / 3) / usual, 1.5, 0.15);
  EXPECT_EQ(automatic_paths(1e4, 0.2, 1), usual) << "photons are few because they are not seen";
  EXPECT_NEAR(automatic_paths(1e4, 1e-3, 1e-3) / usual, tuning::most_paths_in_thin_media, 0.2);
}

/// Shadow rays per camera ray through a ball of optical depth 60 with thin rims.
double shadow_rays_per_ray(double angular_radius) {
  MemoryScene scene;
  const DensityField field = closed_field({8, 8, 8}, [](int i, int j, int k) {
    const double x = i - 32, y = j - 32, z = k - 32;
    return std::max(0.0, 1 - (x * x + y * y + z * z) / 900);
  });
  VolumeSettings& volume =
      scene.add(field, box_map({8, 8, 8}, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  volume.extinction = 100;
  volume.albedo = Rgb(0.99f);
  volume.phase = henyey_greenstein(0.5);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0.8, -0.5, -0.2};
  sun.angular_radius = angular_radius;
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 32, 32);
  const RenderStatistics counts = render_passes(scene, EstimatorType::beam, 1).statistics;
  return static_cast<double>(counts.shadow_rays) / static_cast<double>(counts.depth_profiles);
}

TEST(PhotonPlan, ThickMediaTakeTwoForLightOfOneDirection) {
  EXPECT_LE(shadow_rays_per_ray(0), 2);
  // The phase function seldom finds a disc of 10 degrees, so that there is about a ray per sample.
  EXPECT_GT(shadow_rays_per_ray(10), 2.2);
}

/// A cloud that grows while the shutter is open: render space has another unit from 2 on.
MemoryScene cloud_of(double size) {
  MemoryScene scene;
  const DensityField field = closed_field(
      {8, 8, 8}, [](int i, int j, int k) { return 0.2 + 0.8 * ((i / 8 + j / 8 + k / 8) % 2); });
  VolumeSettings& volume = scene.add(field, box_map({8, 8, 8}, Vec3d(-size / 2), Vec3d(size / 2)));
  volume.extinction = 10 / size;
  volume.albedo = Rgb(0.98f);
  scene.add_light(LightType::distant).direction = {-0.7, -0.5, 0.5};
  scene.look({0.4, 0.3, 6}, {0, 0, 0}, 26, 64, 64);
  return scene;
}

PhotonPlan photons_of(const EstimatorInput& input) {
  return choose_for_scene(input, estimator_kind(EstimatorType::beam)).choices.photons;
}

TEST(PhotonPlan, OfASceneServesMomentsWhoseUnitIsAnother) {
  const TestFrame small(cloud_of(1.9)), large(cloud_of(2.1));
  ASSERT_EQ(small.world.space.scale, 2 * large.world.space.scale);
  const SceneChoices scene = choose_for_scene(small.input(), estimator_kind(EstimatorType::beam));
  const SceneChoices moment = scene.in_units(large.world.space.scale);
  const PhotonPlan &photons = scene.choices.photons, &of_moment = moment.choices.photons;
  ASSERT_NE(photons.guide, nullptr);
  // The same place of the world, and the same light.
  const Vec3f point(0.3f, 0.2f, 0.6f);
  for (const float flux : {0.01f, 1.0f})
    EXPECT_FLOAT_EQ(photons.guide->relative_value(flux, point, 1000),
                    of_moment.guide->relative_value(flux / 4, point * 0.5f, 1000));
  EXPECT_FLOAT_EQ(of_moment.view_reach, 0.5f * photons.view_reach);
  EstimatorInput input = large.input();
  input.of_scene = &moment;
  const PhotonPlan plan = photons_of(input), own = photons_of(large.input());
  EXPECT_GT(own.pilot_paths, 0);
  EXPECT_EQ(plan.pilot_paths, 0);
  EXPECT_EQ(plan.neighbours, photons.neighbours);
  EXPECT_EQ(plan.paths, photons.paths);
  // A point as bright as that is worth as much to either plan, but for the pilots' noise.
  const float follows = plan.guide->relative_value(1, {0, 0, 0.5f}, plan.paths);
  const float asked = own.guide->relative_value(1, {0, 0, 0.5f}, own.paths);
  EXPECT_NEAR(follows / asked, 1, 0.4);
}

} // namespace
} // namespace vdbeam
