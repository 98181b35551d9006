// Kernels are as wide as the noise and the bias of the scene ask for, found out before the first
// pass.
#include "estimators/kernel_pilot.h"

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

/// MRSE of 64 passes with kernels of x times the narrow trial's neighbours, as the choice is meant
/// to minimise it: noise x^-power and bias x^0.5 before it is squared, over passes whose radii, the
/// cube roots of the neighbours, shrink.
double modelled_error(double x, double power, const KernelErrors& errors, double alpha) {
  const double change = std::pow(std::pow(8, 0.5) - 1, 2);
  double noise = 0, bias = 0;
  for (int pass = 0; pass < 64; ++pass) {
    const double scale = static_cast<double>(radius_scale(pass, alpha));
    const double neighbours = x * scale * scale * scale;
    noise += errors.noise_narrow * std::pow(neighbours, -power) / (64 * 64);
    bias += std::sqrt(errors.change / change) * std::pow(neighbours, 0.5) / 64;
  }
  return noise + bias * bias;
}

TEST(BestNeighbours, IsWhereTheErrorIsLeast) {
  for (const double alpha : {0.6, 1.0})
    for (const double change : {0.5, 0.7, 1.0}) {
      const KernelErrors errors{10, 10 / std::pow(8, 0.7), change, 0};
      const double x = best_neighbours(trial(100), trial(800), errors, 1, alpha) / 100;
      const double least = modelled_error(x, 0.7, errors, alpha);
      ASSERT_TRUE(x > 0.33 && x < 7.9) << x; // not at an end of what is trusted
      EXPECT_LT(least, modelled_error(1.05 * x, 0.7, errors, alpha)) << change;
      EXPECT_LT(least, modelled_error(x / 1.05, 0.7, errors, alpha)) << change;
    }
}

TEST(BestNeighbours, FollowsNoiseAndBias) {
  const auto best = [](double noise, double change, double error) {
    return best_neighbours(trial(100), trial(800), {noise, noise / 4, change, error}, 0.25, 0.6);
  };
  EXPECT_GT(best(20, 0.1, 0), best(10, 0.1, 0));
  EXPECT_LT(best(10, 0.2, 0), best(10, 0.1, 0));
  // A bias that does not stand out of the noise may still be as large as that.
  EXPECT_EQ(best(10, -0.3, 0.1), best(10, 0.1, 0.1));
  // Beyond what was tried nothing is known.
  EXPECT_EQ(best(1e9, 1e-9, 0), 800);
  EXPECT_EQ(best(1e-9, 1, 0), 32);
  // Narrow kernels that no ray meets.
  EXPECT_EQ(best(0, 0, 0), 800);
  EXPECT_EQ(best(1, 0, 0), 800);
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
