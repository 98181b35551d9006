// The ground of a plate: the camera sees only the shadows on it.
#include "support/surface_test.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// A catcher at z = 0; the camera sees -0.15 to 0.15 from straight above.
MemoryScene caught() {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(2), of_type(MaterialType::shadow_catcher));
  look_down(scene, 0.15, 16);
  return scene;
}

class ShadowCatcher : public ::testing::TestWithParam<EstimatorType> {};

/// Half of what is seen lies in the shadow of a wall that the camera does not see.
TEST_P(ShadowCatcher, a_wall_in_the_sun) {
  MemoryScene scene = caught();
  scene.add_light(LightType::distant).direction = {0, 0, -1};
  add_surface(scene, SurfaceShape::quad, moved(scaled(1), {-1, 0, 0.5}), diffuse(0)).visible =
      false;
  const PassMeans means = render_passes(scene, GetParam(), 16);
  expect_mean(means.opacity, 0.5, 0.01);
  for (const Rgb& pixel : means.pixels)
    EXPECT_EQ(max_component(pixel), 0) << "only the shadow is seen";
}

/// The sun through a medium that absorbs: the shadow is 1 - Tr. The camera's own ray is dimmed by
/// the same medium.
TEST_P(ShadowCatcher, a_medium_in_the_sun) {
  MemoryScene scene = caught();
  VolumeSettings& box = scene.add_box({-1, -1, 0.2}, {1, 1, 1.2});
  box.extinction = 0.7;
  box.albedo = Rgb(0);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0.28, 0, -0.96};
  const double through = std::exp(-0.7), sunlit = std::exp(-0.7 / 0.96);
  const PassMeans means = render_passes(scene, GetParam(), 4);
  expect_mean(means.opacity, 1 - through * sunlit, 0, 1e-4);
}

/// A wall upright on the line y = 0 hides half of a sky from what is near to it, symmetrically.
TEST_P(ShadowCatcher, half_a_sky) {
  MemoryScene scene = caught();
  look_down(scene, 0.005, 8, {0, 0.05, 0});
  scene.add_light(LightType::environment).radiance = Rgb(1);
  SurfaceSettings& wall = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0));
  wall.transform = {1e3, 0, 0, 0, 0, 0, 1, 0, 0, 1e3, 0, 1e3};
  expect_mean(render_passes(scene, GetParam(), 64).opacity, 0.5, 0.01);
}

/// Catchers cast no shadows: the plate has those. Without anything else nothing is caught.
TEST_P(ShadowCatcher, catchers_do_not_count) {
  MemoryScene scene = caught();
  scene.add_light(LightType::distant).direction = {0, 0, -1};
  add_surface(scene, SurfaceShape::quad, moved(scaled(0.5), {0, 0, 0.5}),
              of_type(MaterialType::shadow_catcher))
      .visible = false;
  const PassMeans means = render_passes(scene, GetParam(), 2);
  EXPECT_EQ(means.opacity.mean(), 0);
  EXPECT_EQ(means.total[0].mean(), 0);
}

/// To all other light it is a diffuse surface.
TEST_P(ShadowCatcher, lights_the_medium_as_a_diffuse_ground) {
  const auto scattered = [&](MaterialType type) {
    MemoryScene scene;
    scene.add_box({-0.5, -0.5, 0.1}, {0.5, 0.5, 0.6}).extinction = 2;
    scene.scene.render.photons = 20000;
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = {0, 0.3, -1};
    MaterialSettings ground = of_type(type);
    ground.albedo = Rgb(0.9f);
    add_surface(scene, SurfaceShape::quad, scaled(2), ground);
    scene.look({3, 0, 0.35}, {0, 0, 0.35}, 6, 16, 16);
    return render_passes(scene, GetParam(), 24).total[0];
  };
  test::expect_same_mean(scattered(MaterialType::shadow_catcher), scattered(MaterialType::diffuse));
}

INSTANTIATE_TEST_SUITE_P(Surfaces, ShadowCatcher,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march,
                                           EstimatorType::path),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
