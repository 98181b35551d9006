#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

// How the beam estimate's two errors fall: noise with passes, bias with radii.
namespace vdbeam {
namespace {

using test::MemoryScene;
using test::PassMeans;

double ball(int i, int j, int k) {
  const double x = i / 8.0 - 1, y = j / 8.0 - 1, z = k / 8.0 - 1;
  return std::max(0.0, 1 - x * x - y * y - z * z);
}

MemoryScene ball_scene() {
  MemoryScene scene;
  const Vec3<int> cells{2, 2, 2};
  VolumeSettings& volume =
      scene.add(test::closed_field(cells, ball), test::box_map(cells, Vec3d(-1), Vec3d(1)));
  volume.extinction = 4;
  volume.albedo = Rgb(0.9f);
  scene.add_light(LightType::distant).direction = {1, -0.5, -0.3};
  scene.look({0, 0, 5}, {0, 0, 0}, 20, 16, 16);
  RenderSettings& render = scene.scene.render;
  render.direct = DirectLight::photons;
  render.kernel = KernelRadius::fixed;
  return scene;
}

/// Mean over the image of the variance of what `passes` passes give, from two independent renders.
double variance_of(MemoryScene scene, int passes) {
  scene.scene.render.seed = 11;
  const PassMeans a = test::render_passes(scene, EstimatorType::beam, passes);
  scene.scene.render.seed = 12;
  const PassMeans b = test::render_passes(scene, EstimatorType::beam, passes);
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::pow(static_cast<double>(a.pixels[i].x - b.pixels[i].x), 2) / 2;
  return sum / static_cast<double>(a.pixels.size());
}

/// Knaus and Zwicker 2011: the variance of pass p goes as 1 / r_p^2, r_p^2 = r_0^2 prod (i + alpha)
/// / (i + 1), so that of the mean of n passes as 1 / n^2 sum 1 / r_p^2, which tends to n^-alpha.
double theory(int passes, double alpha) {
  double squared = 1, sum = 0;
  for (int p = 0; p < passes; ++p) {
    if (p > 0)
      squared *= (p + alpha) / (p + 1);
    sum += 1 / squared;
  }
  return sum / passes / passes;
}

TEST(BeamConvergence, NoiseFallsWithPassesAtTheTheoreticalRate) {
  MemoryScene scene = ball_scene();
  // A few independent photons per kernel: their number is all the noise.
  scene.scene.render.photons = 200;
  scene.scene.render.max_bounces = 1;
  scene.scene.render.radius = 0.15;
  for (const double alpha : {0.4, 1.0}) {
    SCOPED_TRACE(testing::Message() << "alpha " << alpha);
    scene.scene.render.alpha = alpha;
    const double few = variance_of(scene, 4), many = variance_of(scene, 256);
    const double slope = std::log(many / few) / std::log(64.0);
    EXPECT_NEAR(slope, std::log(theory(256, alpha) / theory(4, alpha)) / std::log(64.0), 0.08);
  }
}

/// Two independent renders of one scene.
struct Pair {
  PassMeans a, b;
};
Pair render_pair(MemoryScene scene, EstimatorType type, int passes) {
  scene.scene.render.seed = 21;
  PassMeans a = test::render_passes(scene, type, passes);
  scene.scene.render.seed = 22;
  return {std::move(a), test::render_passes(scene, type, passes)};
}

/// Root mean square bias of the pixels over their mean: the product of two independent differences
/// keeps the bias and loses the noise.
double pixel_bias(const MemoryScene& scene, const Pair& truth, int passes) {
  const Pair pair = render_pair(scene, EstimatorType::beam, passes);
  double product = 0, sum = 0;
  for (std::size_t i = 0; i < truth.a.pixels.size(); ++i) {
    product += static_cast<double>((pair.a.pixels[i].x - truth.a.pixels[i].x) *
                                   (pair.b.pixels[i].x - truth.b.pixels[i].x));
    sum += static_cast<double>(truth.a.pixels[i].x);
  }
  const double n = static_cast<double>(truth.a.pixels.size());
  return std::sqrt(std::max(0.0, product / n)) / (sum / n);
}

class BeamBias : public testing::Test {
protected:
  BeamBias() : scene_(ball_scene()), truth_(render_pair(scene_, EstimatorType::path, 200)) {
    scene_.scene.render.photons = 40000;
    scene_.scene.render.alpha = 1;
  }
  double at_radius(double radius, int passes) {
    scene_.scene.render.radius = radius;
    return pixel_bias(scene_, truth_, passes);
  }
  MemoryScene scene_;
  Pair truth_;
};

TEST_F(BeamBias, VanishesAsRadiiShrink) {
  const double wide = at_radius(0.8, 4), half = at_radius(0.4, 8), quarter = at_radius(0.2, 16);
  EXPECT_GT(wide, 0.05); // else there is nothing to see
  // A kernel of second order: a quarter of the bias for half the radius, in the limit.
  EXPECT_LT(half, 0.5 * wide);
  EXPECT_LT(quarter, 0.5 * half);
}

TEST_F(BeamBias, VanishesWithPasses) {
  scene_.scene.render.alpha = 0.2;
  const double first = at_radius(0.8, 1), many = at_radius(0.8, 32);
  EXPECT_LT(many, 0.4 * first);
}

} // namespace
} // namespace vdbeam
