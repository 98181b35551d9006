#include "estimators/photon_plan.h"

#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

TEST(PhotonPlan, ThinRaysTakeMoreShadowRays) {
  PhotonPlan plan;
  plan.most_direct_samples = 6;
  EXPECT_EQ(plan.direct_samples_of(0), 6);
  EXPECT_EQ(plan.direct_samples_of(3), 3);
  EXPECT_EQ(plan.direct_samples_of(30), 1);
  plan.direct_samples = plan.most_direct_samples = 2; // the user's own number
  EXPECT_EQ(plan.direct_samples_of(0), 2);
  EXPECT_EQ(plan.direct_samples_of(30), 2);
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

TEST(PhotonPlan, ThickMediaTakeOneForLightOfOneDirection) {
  EXPECT_LE(shadow_rays_per_ray(0), 1);
  // The phase function seldom finds a disc of 10 degrees, so that there is about a ray per sample.
  EXPECT_GT(shadow_rays_per_ray(10), 1.5);
}

} // namespace
} // namespace vdbeam
