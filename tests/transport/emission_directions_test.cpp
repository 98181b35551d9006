// Directions towards what glows: their density is what it says, and finds all light.
#include "medium/emission_directions.h"

#include "math/sampling.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

/// Two boxes, one bright and one faint, next to each other in x; in one of them half is dark.
MemoryScene glow() {
  MemoryScene scene;
  scene.add_box({-0.5, -0.5, 0}, {0.5, 0.5, 1}).albedo = Rgb();
  scene.scene.volumes[0].extinction = 0.5;
  scene
      .glow(closed_field({2, 1, 1}, [](int i, int, int) { return i < 8 ? 1.0 : 0.1; }),
            box_map({2, 1, 1}, {-0.5, -0.5, 0}, {0.5, 0.5, 1}))
      .scale = 3;
  return scene;
}

TEST(EmissionDirections, DensityIntegratesToOne) {
  const World world = glow().world();
  const EmissionDirections directions(world.medium.emitters);
  for (const Vec3f& point : {Vec3f{0, 0, -2}, Vec3f{0.1f, 0.2f, 0.1f}, Vec3f{3, 1, 0}}) {
    Samples sum;
    for (std::uint64_t i = 0; i < 200000; ++i) {
      Rng rng({}, RngStage::test, i);
      const float u = rng.uniform(), v = rng.uniform();
      sum.add(4 * std::numbers::pi *
              static_cast<double>(directions.pdf(point, sample_sphere(u, v))));
    }
    expect_mean(sum, 1);
  }
}

/// The mean of x / pdf over the sample is the integral of x over the directions that have a
/// density.
TEST(EmissionDirections, SamplesFollowTheDensity) {
  const World world = glow().world();
  const EmissionDirections directions(world.medium.emitters);
  const Vec3f point{0.3f, -0.2f, -1};
  const auto value = [](const Vec3f& wi) { return static_cast<double>(1 + wi.x + wi.y * wi.z); };
  Samples drawn, even;
  for (std::uint64_t i = 0; i < 100000; ++i) {
    Rng rng({1}, RngStage::test, i);
    const auto sample = directions.sample(point, rng);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->pdf, directions.pdf(point, sample->wi), 1e-4f * sample->pdf);
    drawn.add(value(sample->wi));
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f wi = sample_sphere(u, v);
    even.add(value(wi) * 4 * std::numbers::pi * static_cast<double>(directions.pdf(point, wi)));
  }
  expect_same_mean(drawn, even);
}

/// The ground under a glowing box that neither absorbs nor scatters: irradiance by quadrature.
TEST(EmissionDirections, LightTheGroundUnderAFire) {
  MemoryScene scene;
  scene.add_box({-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}).extinction = 1e-6;
  scene.glow(uniform_field({1, 1, 1}, 1), box_map({1, 1, 1}, {-0.5, -0.5, 0.5}, {0.5, 0.5, 1.5}))
      .scale = 2;
  surfaces::add_surface(scene, SurfaceShape::quad, surfaces::scaled(20), surfaces::diffuse(0.5));
  scene.look({1.4, -1.4, 0.3}, {1.2, -1.2, 0}, 2, 4, 4);
  double irradiance = 0; // of a small patch about (1.2, -1.2, 0): the integral of j cos / d^2
  constexpr int n = 64;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const Vec3d to{(i + 0.5) / n - 0.5 - 1.2, (j + 0.5) / n - 0.5 + 1.2, (k + 0.5) / n + 0.5};
        const double d2 = dot(to, to);
        irradiance += 2 * to.z / (d2 * std::sqrt(d2)) / (n * n * n);
      }
  const PassMeans means = render_passes(scene, EstimatorType::path, 256);
  expect_mean(means.total[0], 0.5 / std::numbers::pi * irradiance, 0.01);
  // 4 walks of 16 pixels and 256 passes: a few percent each, where chance alone had several tens.
  expect_power(means.total[0], 0.01);
}

} // namespace
} // namespace vdbeam
