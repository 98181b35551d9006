// Kernels are as wide as the noise and the bias of the scene ask for, found out before the first
// pass.
#include "choose/pilot/kernel_pilot.h"

#include "support/render_passes.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace vdbeam {
namespace {

using namespace test;

KernelTrial trial(double neighbours) {
  KernelTrial trial;
  trial.neighbours = neighbours;
  return trial;
}

TEST(BestNeighbours, FollowsNoiseAndBias) {
  const auto best = [](double noise, double change, double error) {
    const KernelErrors errors{noise, noise / 4, change, error, {}, {}};
    return KernelModel(trial(100), trial(800), errors, 0.25, 0.6).best_neighbours();
  };
  EXPECT_GT(best(20, 0.1, 0), best(10, 0.1, 0));
  EXPECT_LT(best(10, 0.2, 0), best(10, 0.1, 0));
  // Beyond what was tried nothing is known.
  EXPECT_EQ(best(1e9, 1e-9, 0), 800);
  EXPECT_EQ(best(1e-9, 1, 0), 32);
  // Narrow kernels that no ray meets.
  EXPECT_EQ(best(0, 0, 0), 800);
  EXPECT_EQ(best(1, 0, 0), 800);
}

TEST(BestNeighbours, LeansOnTheUsualNumberWhereTheTrialShowsLittle) {
  const auto best = [](double change, double error) {
    const KernelErrors errors{1, 0.25, change, error, {}, {}};
    return KernelModel(trial(600), trial(2400), errors, 0.25, 0.6).best_neighbours();
  };
  const double sure = best(1, 0), usual = best(0, 1e9);
  EXPECT_LT(sure, 250); // or the test could not distinguish them
  // The expected bias is the mean of what it may be, in which the large ones count most: kernels
  // are somewhat narrower than those that are usual.
  EXPECT_GT(usual, 300);
  EXPECT_LT(usual, 512);
  EXPECT_NEAR(best(1, 0.01), sure, 0.02 * sure);
  EXPECT_GT(best(1, 0.3), 1.02 * sure);
  EXPECT_LT(best(1, 0.3), usual);
  // A change below 0 says that the bias is small, the more so the surer it is.
  EXPECT_GT(best(-0.1, 0.3), usual);
  EXPECT_GT(best(-0.1, 0.15), best(-0.1, 0.3));
  // Hopelessly unlikely measurements still give a number.
  EXPECT_GT(best(-1, 1e-3), 32);
  EXPECT_LE(best(-1, 1e-3), 2400);
}

/// A box of smooth or lumpy medium, 12 mean free paths deep, in sunlight from the side.
MemoryScene box(bool lumpy) {
  MemoryScene scene;
  const DensityField field = closed_field({16, 16, 16}, [lumpy](int i, int j, int k) {
    return !lumpy ? 1 : (i / 2 + j / 2 + k / 2) % 2 == 0 ? 1.9 : 0.1;
  });
  VolumeSettings& volume = scene.add(field, box_map({16, 16, 16}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 12;
  volume.albedo = Rgb(0.95f);
  scene.add_light(LightType::distant).direction = {-0.7, -0.5, -0.5};
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 48, 48);
  scene.scene.render.photons = 20000;
  return scene;
}

double chosen(const MemoryScene& scene, RenderStatistics& statistics) {
  const test::TestFrame frame(scene);
  PassImage image;
  frame.estimator()->render_pass(0, image, statistics);
  return statistics.neighbours;
}

double chosen(const MemoryScene& scene) {
  RenderStatistics statistics;
  return chosen(scene, statistics);
}

TEST(KernelPilot, FollowsTheScene) {
  MemoryScene noisy = box(false), plain = box(false);
  for (VolumeSettings& volume : noisy.scene.volumes)
    volume.phase = henyey_greenstein(0.85);
  // Photons of unlike weight make more noise, in the same light.
  EXPECT_GT(chosen(noisy), 1.5 * chosen(plain));
}

/// MRSE of 64 passes against the mean of two path-traced pictures, free of their noise: the product
/// of the differences to each.
double error_of(MemoryScene scene, int neighbours, const PassMeans& a, const PassMeans& b) {
  scene.scene.render.neighbours = neighbours;
  const PassMeans beam = render_passes(scene, EstimatorType::beam, 64);
  double sum = 0;
  for (std::size_t i = 0; i < beam.brightness.size(); ++i) {
    const double value = beam.brightness[i].mean(), x = a.brightness[i].mean(),
                 y = b.brightness[i].mean();
    const double truth = (x + y) / 2 + 0.01;
    sum += (value - x) * (value - y) / (truth * truth);
  }
  return sum / static_cast<double>(beam.brightness.size());
}

/// What is chosen is nearly the best of what could have been: measured, not modelled.
TEST(SlowKernelPilot, ChoosesNearlyTheBest) {
  for (const bool lumpy : {false, true}) {
    MemoryScene scene = box(lumpy);
    scene.scene.image = {24, 24};
    scene.scene.render.photons = 5000;
    const PassMeans a = render_passes(scene, EstimatorType::path, 300);
    scene.scene.render.seed = 2;
    const PassMeans b = render_passes(scene, EstimatorType::path, 300);
    double least = 1, greatest = 0;
    for (const int neighbours : {32, 100, 320, 1000, 3200}) {
      const double error = error_of(scene, neighbours, a, b);
      least = std::min(least, error);
      greatest = std::max(greatest, error);
    }
    const double chosen_error = error_of(scene, 0, a, b);
    EXPECT_GT(greatest, 3 * least); // or any choice would do
    EXPECT_LT(chosen_error, 1.5 * least);
  }
}

TEST(KernelPilot, DoesNotDependOnTheExposure) {
  MemoryScene dim = box(true);
  for (LightSettings& light : dim.scene.lights)
    light.irradiance = Rgb(1e-12f);
  EXPECT_NEAR(chosen(dim) / chosen(box(true)), 1, 1e-3);
}

TEST(KernelPilot, IsTheSameForAnyThreads) {
  const MemoryScene scene = box(true);
  std::vector<double> neighbours;
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] { neighbours.push_back(chosen(scene)); });
  EXPECT_EQ(neighbours[0], neighbours[1]);
}

TEST(KernelPilot, IsLeftOutWhereNothingDependsOnIt) {
  RenderStatistics with, given, even;
  MemoryScene scene = box(true);
  chosen(scene, with);
  scene.scene.render.neighbours = 300;
  EXPECT_EQ(chosen(scene, given), 300);
  EXPECT_LT(given.importance_rays, with.importance_rays);
  // Where photons may serve frames with other views, kernels must too.
  scene.scene.render.neighbours = 0;
  scene.scene.render.thinning = PhotonThinning::even;
  EXPECT_EQ(chosen(scene, even), 500);
  EXPECT_EQ(even.importance_rays, 0u);
  scene.scene.render.kernel = KernelRadius::fixed;
  scene.scene.render.radius = 0.1;
  EXPECT_EQ(chosen(scene), 0);
}

} // namespace
} // namespace vdbeam
