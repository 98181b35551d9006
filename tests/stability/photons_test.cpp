// Photon maps of degenerate shape, and photon counts from none to more than a machine holds.
#include "photonmap/photon_map.h"
#include "stability/stability_scene.h"

namespace vdbeam {
namespace {

using namespace test;

constexpr int photon_count = 4000;

PhotonList photons_at(Vec3f (*place)(float u, float v)) {
  PhotonList photons;
  for (std::uint64_t i = 0; i < photon_count; ++i) {
    Rng rng({}, RngStage::test, i);
    const float u = rng.uniform(), v = rng.uniform();
    photons.position.push_back(place(u, v));
    photons.power.push_back(Rgb(1.0f / photon_count));
  }
  return photons;
}

/// Integral over a screen of side 2 of what rays along z see: each ray's weights are 1, so the
/// photons' power over 4 pi, whatever the kernels' size, if they lie on the screen.
double power_on_screen(const PhotonMap& map, int samples) {
  const std::vector<PhaseFunction> phases(1);
  const std::vector<float> weights(5, 1.0f);
  double sum = 0;
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x) {
      PhotonMap::RayProfile profile;
      profile.ray = {{(static_cast<float>(x) + 0.5f) * 2 / static_cast<float>(samples) - 1,
                      (static_cast<float>(y) + 0.5f) * 2 / static_cast<float>(samples) - 1, -2},
                     {0, 0, 1}};
      profile.step = 1;
      profile.knots = 5;
      profile.weights = weights.data();
      profile.phases = &phases;
      Rgb radiance(0);
      map.query_ray(profile, radiance);
      EXPECT_TRUE(std::isfinite(radiance.x));
      EXPECT_GE(radiance.x, 0);
      sum += static_cast<double>(radiance.x);
    }
  return sum * 4 / (samples * samples) * 4 * std::numbers::pi;
}

struct Shape {
  std::string name;
  Vec3f (*place)(float u, float v);
};

class DegenerateMap : public ::testing::TestWithParam<Shape> {};

/// With a least radius that the rays of the screen resolve, all the power is found.
TEST_P(DegenerateMap, KeepsItsPower) {
  RadiusSettings radii;
  radii.min_radius = 0.1f;
  const PhotonMap map =
      PhotonMap::build(photons_at(GetParam().place), 1, radii, KernelShape::biweight);
  ASSERT_EQ(map.size(), static_cast<std::size_t>(photon_count));
  EXPECT_NEAR(power_on_screen(map, 100), 1, 0.01);
}

/// Without one, radii are small but neither 0 nor NaN, and a ray through a photon sees it finite.
TEST_P(DegenerateMap, HasFiniteKernels) {
  const PhotonMap map =
      PhotonMap::build(photons_at(GetParam().place), 1, {}, KernelShape::biweight);
  EXPECT_GT(map.mean_radius(), 0);
  EXPECT_LT(map.mean_radius(), 10);
  EXPECT_GE(power_on_screen(map, 20), 0);
}

INSTANTIATE_TEST_SUITE_P(Shapes, DegenerateMap,
                         ::testing::Values(Shape{"Point",
                                                 [](float, float) {
                                                   return Vec3f{0.1f, 0.2f, 0.3f};
                                                 }},
                                           Shape{"Line",
                                                 [](float u, float) {
                                                   return Vec3f{u - 0.5f, 0.1f, 0.2f};
                                                 }},
                                           Shape{"LineOfSight",
                                                 [](float u, float) {
                                                   return Vec3f{0.1f, 0.2f, u};
                                                 }},
                                           Shape{"Plane",
                                                 [](float u, float v) {
                                                   return Vec3f{u - 0.5f, v - 0.5f, 0};
                                                 }}),
                         [](const auto& shape) { return shape.param.name; });

/// A light in the middle of one tiny dense voxel: all photons lie at one point, to a camera far
/// off.
TEST(Photons, AllAtOnePoint) {
  MemoryScene scene = box_scene(1e6, 0.9);
  scene.add_light(LightType::point).position = {0, 0, 0.4999995};
  scene.scene.render.direct = DirectLight::photons;
  scene.scene.render.photons = 20000;
  render_sound(scene, EstimatorType::beam, 2, "light under the surface");
}

TEST(Photons, MoreNeighboursThanPhotons) {
  MemoryScene scene = box_scene(2);
  add_sky(scene);
  scene.scene.render.photons = 50;
  scene.scene.render.neighbours = 100000;
  const PassMeans means = render_sound(scene, EstimatorType::beam, 100, "k > photons");
  // A furnace; kernels are as wide as the medium at most, and blur its border.
  expect_mean(means.total[0], 1, 0.1);
  expect_power(means.total[0], 0.03);
}

TEST(Photons, OnePhoton) {
  MemoryScene scene = box_scene(2);
  add_sky(scene);
  scene.scene.render.photons = 1;
  render_sound(scene, EstimatorType::beam, 8, "one photon");
  render_sound(scene, EstimatorType::march, 2, "one photon, march");
}

TEST(Photons, NoneStored) {
  MemoryScene dark = box_scene(2);
  add_sky(dark, 0);
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    const PassMeans means = render_sound(dark, type, 2, "a light without power");
    EXPECT_EQ(means.total[0].mean(), 0);
    EXPECT_GT(means.opacity.mean(), 0.5);
  }
  MemoryScene lightless = box_scene(2);
  EXPECT_EQ(render_sound(lightless, EstimatorType::beam, 1, "no light").total[0].mean(), 0);
}

/// Adaptive kernels never grow wider than the medium. A fixed one may, if the user asks for it: it
/// loses light, and render() says so (Limits.KernelWiderThanTheMediumIsNoted).
TEST(Photons, KernelLargerThanTheVolume) {
  MemoryScene scene = box_scene(5);
  add_sky(scene);
  scene.scene.render.photons = 20000;
  scene.scene.render.kernel = KernelRadius::fixed;
  for (const double radius : {0.02, 1.0, 5.0, 1000.0}) {
    scene.scene.render.radius = radius;
    const PassMeans means =
        render_sound(scene, EstimatorType::beam, 2, "radius " + std::to_string(radius));
    // Kernels of the unit box's own size count a photon by the part of them that lies in the box,
    // which is right on average but not at the middle.
    EXPECT_LT(means.total[0].mean(), radius < 0.1 ? 1.05 : 1.3) << radius;
    EXPECT_GT(means.total[0].mean(), radius < 0.1 ? 0.95 : radius > 2 ? 0 : 0.5) << radius;
  }
}

} // namespace
} // namespace vdbeam
