// A ground without an end, with every estimator.
#include "support/lumpy_cloud.h"
#include "support/surface_test.h"

#include "photons/photon_plan.h"
#include "transport/photon_tracing.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// The plane y = `height`, front up.
Transform ground(double height, double scale = 1) {
  return {scale, 0, 0, 0, 0, 0, scale, height, 0, -scale, 0, 0};
}

/// A cloud over a ground, in the sun and under a sky, seen up to the horizon.
MemoryScene cloud_over(SurfaceShape shape, double scale) {
  MemoryScene scene = test::lumpy_cloud(8, 16);
  scene.scene.volumes[0].albedo = Rgb(0.95f);
  scene.add_light(LightType::environment).radiance = Rgb(0.3f);
  add_surface(scene, shape, ground(-0.7, scale), diffuse(0.6));
  scene.scene.render.photons = 20000;
  scene.look({0.5, 0.4, 3}, {0, -0.2, 0}, 34, 16, 16);
  return scene;
}

class Plane : public ::testing::TestWithParam<EstimatorType> {};

/// All estimators see the ground, its shadows and what it sends to the cloud as path does, and as
/// they see a very large square.
TEST_P(Plane, IsWhatPathAndAVeryLargeSquareShow) {
  const MemoryScene scene = cloud_over(SurfaceShape::plane, 1);
  const PassMeans means = render_passes(scene, GetParam(), 48);
  const PassMeans truth = render_passes(scene, EstimatorType::path, 128);
  EXPECT_EQ(regions_apart(means, truth, 0.02), 0);
  test::expect_same_mean(means.total[0], truth.total[0], 0.01 * truth.total[0].mean());
  const PassMeans square =
      render_passes(cloud_over(SurfaceShape::quad, 10000), EstimatorType::path, 128);
  EXPECT_EQ(regions_apart(means, square, 0.02), 0);
  test::expect_power(truth.total[0], 0.02 * truth.total[0].mean());
}

/// Beside a white sky of radiance 1 a white ground sends 1 too: with fog without absorption, all
/// is 1.
TEST_P(Plane, AWhiteOneIsAFurnace) {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 1.5;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  scene.scene.render.photons = 20000;
  add_surface(scene, SurfaceShape::plane, ground(-1.2), white());
  scene.look({0, 0.5, 4}, {0, -0.1, 0}, 50, 8, 8);
  expect_mean(render_passes(scene, GetParam(), 48).total[0], 1, 0.01);
}

/// Looking along it, half of the picture is ground, whatever the scale and the height.
TEST_P(Plane, HasACleanHorizon) {
  for (const double height : {1.7, 3000.0}) {
    MemoryScene scene;
    scene.add_box(Vec3d{-20, 900, -20}, Vec3d{20, 940, 20}).extinction = 1e-3;
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = {0, -1, 0};
    sun.irradiance = Rgb(3.14159265f);
    add_surface(scene, SurfaceShape::plane, ground(0), diffuse(0.5));
    scene.look({0, height, 5000}, {0, height, 4000}, 40, 16, 16);
    const PassMeans means = render_passes(scene, GetParam(), 4);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        if (x < 6 || x > 9) { // beside the fog and its shadow
          EXPECT_NEAR(means.pixels[static_cast<std::size_t>(16 * y + x)][1], y < 8 ? 0 : 0.5, 2e-3)
              << height << ": " << x << " " << y;
        }
  }
}

/// The shadow on a plane is that on a square.
TEST_P(Plane, CatchesShadowsAndHoldsOut) {
  MemoryScene scene;
  scene.add_light(LightType::distant).direction = {0, 0, -1};
  add_surface(scene, SurfaceShape::plane, scaled(2), of_type(MaterialType::shadow_catcher));
  add_surface(scene, SurfaceShape::quad, moved(scaled(1), {-1, 0, 0.5}), diffuse(0)).visible =
      false;
  look_down(scene, 0.15, 16);
  expect_mean(render_passes(scene, GetParam(), 16).opacity, 0.5, 0.01);
  scene.scene.surfaces[0].material = of_type(MaterialType::holdout);
  const PassMeans hole = render_passes(scene, GetParam(), 2);
  EXPECT_EQ(hole.opacity.mean(), 0);
  EXPECT_EQ(hole.total[0].mean(), 0);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Plane,
                         ::testing::Values(EstimatorType::beam, EstimatorType::gather,
                                           EstimatorType::march, EstimatorType::path),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

/// A plane takes no more photons from the medium than a square that is as wide as the scene.
TEST(Plane, CostsNoPhotons) {
  const auto stored = [](SurfaceShape shape, double scale) {
    const MemoryScene scene = cloud_over(shape, scale);
    const test::TestFrame frame(scene);
    PhotonPassSettings settings =
        pass_settings(frame.input(), default_photon_plan(frame.input()), 1);
    settings.paths = 4000;
    return trace_photons(frame.world, settings).mean_collisions;
  };
  EXPECT_GT(stored(SurfaceShape::plane, 1), 0.5 * stored(SurfaceShape::quad, 1));
}

/// A sea: what it reflects and lets through to a white ground, and that sends back, is 1 in all.
TEST(Plane, MayBeWater) {
  MemoryScene scene;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  MaterialSettings water = glass();
  water.ior = 1.33;
  add_surface(scene, SurfaceShape::plane, ground(0), water);
  add_surface(scene, SurfaceShape::plane, ground(-0.5), white());
  scene.look({0, 1, 4}, {0, 0, 0}, 50, 8, 8);
  expect_mean(render_passes(scene, EstimatorType::path, 64).total[0], 1, 0.01);
}

} // namespace
} // namespace vdbeam
