// What mirrors, glass and metal show of their surroundings.
#include "materials/fresnel.h"
#include "support/surface_test.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test::surfaces;

MaterialSettings rough(MaterialType type, double roughness) {
  MaterialSettings material = of_type(type);
  material.roughness = roughness;
  return material;
}

class Reflections : public ::testing::TestWithParam<EstimatorType> {};

/// Panes of glass in the plane z = 0, seen at 45 degrees, which reflect a bright ceiling.
MemoryScene panes(int interfaces) {
  MemoryScene scene;
  for (int i = 0; i < interfaces; ++i)
    add_surface(scene, SurfaceShape::quad, moved(scaled(1), {0, 0, -0.001 * i}, i % 2 == 1),
                of_type(MaterialType::dielectric));
  add_surface(scene, SurfaceShape::quad, moved(scaled(4), {0, 0, 2}, true), shining(100));
  scene.look({0, -1, 1}, {0, 0, 0}, 2, 4, 4);
  return scene;
}

/// The share of light that one interface reflects at 45 degrees.
double reflected_at_45_degrees() {
  float cos_t = 0;
  return static_cast<double>(fresnel_dielectric(std::sqrt(0.5f), 1.5f, cos_t));
}

/// The faint reflection of a lamp is no matter of chance: it is the same in each pixel and pass.
TEST_P(Reflections, of_a_lamp_in_one_interface) {
  const double expected = 100 * reflected_at_45_degrees();
  const PassMeans means = render_passes(panes(1), GetParam(), 4);
  expect_mean(means.total[0], expected, 0.01 * expected);
  for (const test::Samples& pixel : means.brightness)
    EXPECT_NEAR(pixel.mean(), expected, 0.05 * expected);
}

/// With a second interface behind it only what goes to and fro between the two is: R^2 of it all.
TEST_P(Reflections, of_a_lamp_in_a_pane) {
  const double once = reflected_at_45_degrees();
  const double expected = 100 * 2 * once / (1 + once);
  const PassMeans means = render_passes(panes(2), GetParam(), 64);
  expect_mean(means.total[0], expected, 0.005 * expected);
  double square = 0;
  for (const test::Samples& pixel : means.brightness)
    square += pixel.error() * pixel.error() * 64;
  EXPECT_LT(std::sqrt(square / static_cast<double>(means.brightness.size())), 0.2 * expected);
}

/// What frosted glass reflects, a twentieth of the light, is in each pass too: one interface, over
/// nothing, and a white ceiling that a point light shines on.
TEST_P(Reflections, in_frosted_glass_are_no_speckles) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(1), rough(MaterialType::dielectric, 0.1));
  add_surface(scene, SurfaceShape::quad, moved(scaled(4), {0, 0, 2}, true), {});
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {0, 2, -1};
  lamp.intensity = Rgb(1000);
  scene.look({0, -1, 1}, {0, 0, 0}, 2, 4, 4);
  const PassMeans means = render_passes(scene, GetParam(), 32);
  double mean = 0, square = 0;
  for (const test::Samples& pixel : means.brightness) {
    mean += pixel.mean();
    square += pixel.error() * pixel.error() * 32;
  }
  const auto pixels = static_cast<double>(means.brightness.size());
  EXPECT_GT(mean, 0);
  // By chance, one path in twenty, it would be 2.2 times the mean.
  EXPECT_LT(std::sqrt(square / pixels), 0.5 * mean / pixels);
}

/// A ball in fog with a lamp beside it and a floor below, which path tracing sees as well.
MemoryScene ball_in_fog(const MaterialSettings& material) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box({-1, -1, -0.6}, {1, 1, 1});
  box.extinction = 1.5;
  box.albedo = Rgb(0.9f);
  add_surface(scene, SurfaceShape::sphere, scaled(0.4), material);
  add_surface(scene, SurfaceShape::quad, moved(scaled(2), {0, 0, -0.61}), {});
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {0.6, -0.5, 0.6}), shining(20));
  scene.scene.render.photons = 10000;
  scene.look({0, -3, 0.8}, {0, 0, 0}, 24, 12, 12);
  return scene;
}

/// Lobes of all widths: those that rays follow and those on which photons are gathered.
TEST_P(Reflections, of_rough_metal_and_glass_in_fog) {
  for (const MaterialSettings& material :
       {rough(MaterialType::conductor, 0.15), rough(MaterialType::conductor, 0.4),
        rough(MaterialType::conductor, 0.7), rough(MaterialType::dielectric, 0.3)}) {
    const MemoryScene scene = ball_in_fog(material);
    const PassMeans path = render_passes(scene, EstimatorType::path, 64);
    const PassMeans mine = render_passes(scene, GetParam(), 12);
    EXPECT_EQ(test::regions_apart(mine, path, 0.03), 0)
        << material.type.name << " " << *material.roughness << ": " << mine.total[0].mean()
        << " against " << path.total[0].mean();
  }
}

/// A lamp that fills much of what metal shows is met by rays and sampled by shadow rays: once.
TEST_P(Reflections, of_a_large_lamp_in_rough_metal) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::quad, scaled(1), rough(MaterialType::conductor, 0.4));
  add_surface(scene, SurfaceShape::quad, moved(scaled(0.7), {0, 0.4, 1}, true), shining(2));
  scene.add_light(LightType::environment).radiance = Rgb(0.5f);
  scene.look({0, -1, 1}, {0, 0, 0}, 20, 16, 16);
  const PassMeans path = render_passes(scene, EstimatorType::path, 256);
  const PassMeans mine = render_passes(scene, GetParam(), 64);
  test::expect_power(mine.total[0], 0.01 * path.total[0].mean());
  EXPECT_EQ(test::regions_apart(mine, path, 0.001), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

/// Frosted glass shows a lamp behind it by rays of their own: it counts once, inside and outside.
TEST_P(Reflections, of_and_lamps_behind_frosted_glass) {
  MemoryScene scene;
  add_surface(scene, SurfaceShape::sphere, scaled(0.5), rough(MaterialType::dielectric, 0.4));
  add_surface(scene, SurfaceShape::quad, moved(scaled(0.5), {0, 0, -1}), shining(4));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.2), {0.4, 0.2, 0.8}), shining(10));
  scene.add_light(LightType::environment).radiance = Rgb(0.2f);
  scene.look({0, 0, 3}, {0, 0, 0}, 18, 16, 16);
  const PassMeans path = render_passes(scene, EstimatorType::path, 256);
  const PassMeans mine = render_passes(scene, GetParam(), 32);
  test::expect_power(mine.total[0], 0.01 * path.total[0].mean());
  EXPECT_EQ(test::regions_apart(mine, path, 0.002), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
}

INSTANTIATE_TEST_SUITE_P(Surfaces, Reflections,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
