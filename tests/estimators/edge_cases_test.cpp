#include "support/memory_scene.h"
#include "support/render_passes.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstring>

namespace vdbeam {
namespace {

using test::MemoryScene;

/// Everything at once: two overlapping volumes of different colour, phase function and lattice, all
/// kinds of light.
MemoryScene rich_scene() {
  MemoryScene scene;
  const Vec3<int> cells{2, 2, 2};
  VolumeSettings& first = scene.add(
      test::closed_field(cells, [](int i, int j, int k) { return test::lattice_noise(i, j, k); }),
      test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  first.extinction = 6;
  first.extinction_scale = {1, 0.6f, 0.3f};
  first.albedo = {0.95f, 0.8f, 0.6f};
  first.phase = test::henyey_greenstein(0.5);
  VolumeSettings& second = scene.add(
      test::uniform_field({1, 1, 1}, 1),
      test::turn({1, 2, 0}, 30).after(test::box_map({1, 1, 1}, {0, -0.3, -0.3}, {0.7, 0.3, 0.3})));
  second.extinction = 3;
  second.albedo = Rgb(0.9f);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {1, -0.6, -0.2};
  sun.angular_radius = 2;
  scene.add_light(LightType::point).position = {0.1, 0.2, 0.1};
  LightSettings& spot = scene.add_light(LightType::spot);
  spot.position = {0, 2, 0};
  scene.add_light(LightType::environment).radiance = {0.1f, 0.2f, 0.3f};
  scene.look({0.4, 0.5, 3}, {0.05, 0.02, 0}, 30, 21, 18);
  scene.scene.render.photons = 3000;
  return scene;
}

PassImage one_pass(MemoryScene scene, EstimatorType type, int pass = 0) {
  scene.scene.render.estimator = type;
  const test::TestFrame frame(scene);
  PassImage image;
  RenderStatistics statistics;
  frame.estimator()->render_pass(pass, image, statistics);
  EXPECT_EQ(statistics.camera_rays, image.direct.size());
  return image;
}

bool same_bits(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Rgb)) == 0;
}

void expect_same_bits(const PassImage& a, const PassImage& b) {
  EXPECT_TRUE(same_bits(a.direct, b.direct));
  EXPECT_TRUE(same_bits(a.indirect, b.indirect));
  EXPECT_TRUE(same_bits(a.background, b.background));
  EXPECT_EQ(a.opacity, b.opacity);
  EXPECT_EQ(a.depth, b.depth);
}

void expect_finite(const PassImage& image) {
  for (std::size_t i = 0; i < image.direct.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      ASSERT_TRUE(std::isfinite(image.direct[i][c]) && image.direct[i][c] >= 0);
      ASSERT_TRUE(std::isfinite(image.indirect[i][c]) && image.indirect[i][c] >= 0);
      ASSERT_TRUE(std::isfinite(image.background[i][c]) && image.background[i][c] >= 0);
      ASSERT_TRUE(image.opacity[i] >= 0 && image.opacity[i] <= 1);
      ASSERT_TRUE(std::isfinite(image.depth[i]) && image.depth[i] >= 0);
    }
}

float sum(const std::vector<Rgb>& values) {
  float total = 0;
  for (const Rgb& value : values)
    total += value.x + value.y + value.z;
  return total;
}

class EveryEstimator : public testing::TestWithParam<EstimatorType> {};

TEST_P(EveryEstimator, SameBitsForOneTwoAndFiveThreads) {
  for (const PhotonStore store : {PhotonStore::fluence, PhotonStore::scatter}) {
    MemoryScene scene = rich_scene();
    scene.scene.render.store = store;
    std::vector<PassImage> images;
    for (const std::size_t threads : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
      tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      images.push_back(one_pass(scene, GetParam(), 2));
    }
    expect_finite(images[0]);
    EXPECT_GT(sum(images[0].direct), 0);
    EXPECT_GT(sum(images[0].indirect), 0);
    expect_same_bits(images[0], images[1]);
    expect_same_bits(images[0], images[2]);
  }
}

// A pass is a pure function of its number: the order and choice of passes before it are nothing to
// it, so machines can share out the passes.
TEST_P(EveryEstimator, PassesDoNotDependOnThoseBefore) {
  MemoryScene scene = rich_scene();
  scene.scene.render.estimator = GetParam();
  const test::TestFrame frame(scene);
  const auto estimator = frame.estimator();
  PassImage image;
  RenderStatistics statistics;
  for (const int pass : {0, 5, 3})
    estimator->render_pass(pass, image, statistics);
  expect_same_bits(image, one_pass(scene, GetParam(), 3));
  const PassImage other = one_pass(scene, GetParam(), 4);
  EXPECT_FALSE(same_bits(image.direct, other.direct));
  EXPECT_FALSE(same_bits(image.indirect, other.indirect));
}

TEST_P(EveryEstimator, SeedAndFrameChangeTheNoise) {
  MemoryScene scene = rich_scene();
  const PassImage image = one_pass(scene, GetParam());
  scene.scene.render.seed = 2;
  EXPECT_FALSE(same_bits(image.indirect, one_pass(scene, GetParam()).indirect));
}

TEST_P(EveryEstimator, EmptyMediumShowsTheSky) {
  MemoryScene scene;
  scene.add(DensityField(), Affine());
  scene.add_light(LightType::environment).radiance = {1, 2, 3};
  scene.add_light(LightType::distant);
  scene.add_light(LightType::point);
  scene.look({0, 0, 3}, {0, 0, 0}, 30, 5, 3);
  const PassImage image = one_pass(scene, GetParam());
  for (std::size_t i = 0; i < image.direct.size(); ++i) {
    EXPECT_EQ(test::pixel_total(image, i), Rgb(1, 2, 3));
    EXPECT_EQ(image.opacity[i], 0);
    EXPECT_EQ(image.depth[i], 0);
  }
}

TEST_P(EveryEstimator, WithoutLightsItIsBlack) {
  MemoryScene scene = rich_scene();
  scene.scene.lights.clear();
  const PassImage image = one_pass(scene, GetParam());
  EXPECT_EQ(sum(image.direct) + sum(image.indirect) + sum(image.background), 0);
  EXPECT_GT(*std::max_element(image.opacity.begin(), image.opacity.end()), 0);
  scene.add_light(LightType::point).intensity = Rgb(0);
  scene.add_light(LightType::distant).irradiance = Rgb(0);
  scene.add_light(LightType::environment).radiance = Rgb(0);
  const PassImage dark = one_pass(scene, GetParam());
  expect_finite(dark);
  EXPECT_EQ(sum(dark.direct) + sum(dark.indirect) + sum(dark.background), 0);
}

TEST_P(EveryEstimator, OnePixel) {
  MemoryScene scene = rich_scene();
  scene.scene.image = {1, 1};
  const PassImage image = one_pass(scene, GetParam());
  ASSERT_EQ(image.direct.size(), 1u);
  expect_finite(image);
  EXPECT_GT(sum(image.direct) + sum(image.indirect), 0);
}

TEST_P(EveryEstimator, LookingAwaySeesTheSkyOnly) {
  MemoryScene scene = rich_scene();
  scene.look({0.4, 0.5, 3}, {0.4, 0.5, 6}, 30, 9, 9);
  const PassImage image = one_pass(scene, GetParam());
  EXPECT_EQ(sum(image.direct) + sum(image.indirect), 0);
  EXPECT_EQ(image.background[40], Rgb(0.1f, 0.2f, 0.3f));
}

TEST_P(EveryEstimator, CameraInsideTheMediumOrOnALightIsFinite) {
  MemoryScene scene = rich_scene();
  for (const Vec3d& position : {Vec3d(0.01, 0.02, 0.03), Vec3d(0.1, 0.2, 0.1), Vec3d(-0.5, 0, 0)}) {
    scene.look(position, position + Vec3d{1, 0.3, -2}, 100, 17, 17);
    const PassImage image = one_pass(scene, GetParam());
    expect_finite(image);
    EXPECT_GT(sum(image.indirect), 0);
  }
}

TEST_P(EveryEstimator, ExtremeExtinctionIsFinite) {
  for (const double extinction : {1e-8, 1e6}) {
    MemoryScene scene = rich_scene();
    scene.scene.volumes[0].extinction = extinction;
    scene.scene.volumes[0].albedo = Rgb(0.1f);
    scene.scene.render.photons = 500;
    expect_finite(one_pass(scene, GetParam()));
  }
}

/// Depth and opacity are those of the profile, whatever the estimator.
TEST_P(EveryEstimator, OpacityAndDepth) {
  MemoryScene scene;
  scene.add_box(Vec3d(-0.5), Vec3d(0.5)).extinction = 200;
  scene.add_light(LightType::environment);
  scene.look({0, 0, 50}, {0, 0, 0}, 0.1, 4, 4);
  scene.scene.render.photons = 500;
  const PassImage image = one_pass(scene, GetParam());
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    EXPECT_NEAR(image.opacity[i], 1, 1e-5);
    EXPECT_NEAR(image.depth[i] / image.opacity[i], 49.5 + 1.0 / 200, 1e-4);
  }
}

std::string estimator_name(const testing::TestParamInfo<EstimatorType>& type) {
  return type.param == EstimatorType::path   ? "path"
         : type.param == EstimatorType::beam ? "beam"
                                             : "march";
}
INSTANTIATE_TEST_SUITE_P(Estimators, EveryEstimator,
                         testing::Values(EstimatorType::path, EstimatorType::beam,
                                         EstimatorType::march),
                         estimator_name);

} // namespace
} // namespace vdbeam
