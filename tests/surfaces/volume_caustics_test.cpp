// Light that mirrors bring into a medium, where rays from the medium meet its lamp by chance only.
#include "support/fog_scene.h"
#include "support/surface_test.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

using namespace test::surfaces;

class VolumeCaustics : public ::testing::TestWithParam<EstimatorType> {};

/// A ball of fog in sunlight that travels along `direction`.
MemoryScene sunlit_fog(const Vec3d& direction) {
  MemoryScene scene;
  VolumeSettings volume = test::fog(VolumeShape::sphere, {-1, -1, -1}, {1, 1, 1}, 2);
  volume.albedo = Rgb(0.95f);
  test::add_fog(scene, volume);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = direction;
  sun.irradiance = Rgb(3);
  sun.angular_radius = 0.27;
  scene.look({0, 0, 6}, {0, 0, 0}, 24, 24, 24);
  scene.scene.render.photons = 100000;
  return scene;
}

/// A mirror far below turns the sun upwards, and a black sheet keeps its straight light away.
TEST_P(VolumeCaustics, a_mirror_turns_the_sun) {
  MemoryScene scene = sunlit_fog({1, 0, 0});
  const double half = 2.5 / std::numbers::sqrt2;
  add_surface(scene, SurfaceShape::quad, {half, 0, -1, 0, half, 0, 1, -20, 0, -2.5, 0, 0},
              of_type(MaterialType::mirror));
  add_surface(scene, SurfaceShape::quad, {0, 0, 1, -5, 2, 0, 0, 0, 0, 2, 0, 0}, diffuse(0));
  const PassMeans turned = render_passes(scene, GetParam(), 16);
  static const PassMeans straight = // the same for every estimator
      render_passes(sunlit_fog({0, 1, 0}), EstimatorType::path, 64);
  expect_power(turned.total[0], 0.02 * straight.total[0].mean());
  test::expect_same_mean(turned.total[0], straight.total[0], 0.03 * straight.total[0].mean());
}

INSTANTIATE_TEST_SUITE_P(Estimators, VolumeCaustics,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march,
                                           EstimatorType::gather),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
