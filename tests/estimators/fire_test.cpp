#include "support/memory_scene.h"
#include "support/render_passes.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

// A small fire: lumpy smoke and, beside and above it, lumpy flames on a lattice of their own.
namespace vdbeam {
namespace {

using test::MemoryScene;
using test::PassMeans;

double moving_blobs(int i, int j, int k, double phase) {
  const double x = i / 24.0, y = j / 24.0, z = k / 24.0;
  const double border = 64 * x * (1 - x) * y * (1 - y) * z * (1 - z);
  return border * (1 + std::sin(9 * x + phase) * std::cos(7 * y + 1) * std::sin(8 * z + 2));
}

MemoryScene fire() {
  MemoryScene scene;
  const Vec3<int> cells{3, 3, 3};
  VolumeSettings& volume = scene.add(
      test::closed_field(cells, [](int i, int j, int k) { return moving_blobs(i, j, k, 0); }),
      test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 6;
  volume.albedo = {0.9f, 0.8f, 0.6f};
  volume.phase = test::henyey_greenstein(0.5);
  EmissionSettings& emission = scene.glow(
      test::closed_field(cells, [](int i, int j, int k) { return moving_blobs(i, j, k, 2); }),
      test::turn({1, 0, 1}, 25).after(test::box_map(cells, {-0.3, -0.2, -0.4}, {0.3, 0.7, 0.3})));
  emission.color = {1, 0.4f, 0.1f};
  emission.scale = 5;
  scene.look({0.5, 0.6, 2.5}, {0, 0.1, 0}, 28, 16, 16);
  RenderSettings& render = scene.scene.render;
  render.photons = 20000;
  render.kernel = KernelRadius::fixed;
  render.radius = 0.06;
  return scene;
}

void expect_agreement(const MemoryScene& scene, EstimatorType type, const PassMeans& truth) {
  const PassMeans means = test::render_passes(scene, type, 24);
  for (std::size_t c = 0; c < 3; ++c) {
    const double mean = truth.total[c].mean();
    test::expect_same_mean(means.total[c], truth.total[c], 0.005 * mean);
    EXPECT_LT(means.total[c].error(), 0.01 * mean);
  }
}

TEST(Fire, EstimatorsAgree) {
  MemoryScene scene = fire();
  const PassMeans truth = test::render_passes(scene, EstimatorType::path, 32);
  expect_agreement(scene, EstimatorType::beam, truth);
  expect_agreement(scene, EstimatorType::march, truth);
  scene.scene.render.store = PhotonStore::scatter;
  scene.scene.render.radius = 0.04;
  const PassMeans scatter = test::render_passes(scene, EstimatorType::beam, 24);
  test::expect_same_mean(scatter.total[0], truth.total[0], 0.015 * truth.total[0].mean());
}

TEST(Fire, WithASunToo) {
  MemoryScene scene = fire();
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {1, -0.6, -0.2};
  sun.irradiance = Rgb(2);
  scene.scene.volumes[0].extinction_scale = {1, 0.6f, 0.3f};
  const PassMeans truth = test::render_passes(scene, EstimatorType::path, 48);
  expect_agreement(scene, EstimatorType::beam, truth);
  expect_agreement(scene, EstimatorType::march, truth);
}

/// Emission seen through k scatterings counts as k bounces, in every estimator.
TEST(Fire, BounceLimits) {
  double before = 0;
  for (const int bounces : {1, 2}) {
    SCOPED_TRACE(bounces);
    MemoryScene scene = fire();
    scene.scene.render.max_bounces = bounces;
    const PassMeans truth = test::render_passes(scene, EstimatorType::path, 32);
    expect_agreement(scene, EstimatorType::beam, truth);
    expect_agreement(scene, EstimatorType::march, truth);
    EXPECT_GT(truth.total[0].mean(), before * 1.01);
    before = truth.total[0].mean();
  }
}

TEST(Fire, DoesNotDependOnThreads) {
  for (const EstimatorType type :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::path}) {
    PassImage images[2];
    for (const std::size_t threads : {std::size_t{1}, std::size_t{2}}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      MemoryScene scene = fire();
      scene.scene.render.estimator = type;
      const test::TestFrame frame(scene);
      RenderStatistics statistics;
      frame.estimator()->render_pass(3, images[threads - 1], statistics);
    }
    EXPECT_EQ(images[0].emission, images[1].emission);
    EXPECT_EQ(images[0].direct, images[1].direct);
    EXPECT_EQ(images[0].indirect, images[1].indirect);
  }
}

/// A flame without smoke, and one behind black smoke: no noise, the same in every estimator.
TEST(Fire, WithoutScattering) {
  for (const double extinction : {0.0, 6.0}) {
    MemoryScene scene = fire();
    scene.scene.volumes[0].extinction = extinction;
    scene.scene.volumes[0].albedo = Rgb(0);
    const PassMeans truth = test::render_passes(scene, EstimatorType::path, 1);
    for (const EstimatorType type : {EstimatorType::beam, EstimatorType::march})
      EXPECT_EQ(test::render_passes(scene, type, 1).pixels, truth.pixels);
    EXPECT_GT(truth.total[0].mean(), 0.05);
    // Colours differ only where the smoke is coloured.
    EXPECT_NEAR(truth.total[2].mean() / truth.total[0].mean(), 0.1, 1e-5);
  }
}

} // namespace
} // namespace vdbeam
