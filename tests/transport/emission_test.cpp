#include "medium/emission.h"
#include "support/exact_field.h"
#include "support/make_field.h"
#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr float cutoff = 1e-6f;

/// Radiance along z through the middle of a unit cube in world space, from z = 0.5 to -0.5.
double along_z(const MemoryScene& scene) {
  const World world = scene.world();
  const Ray ray{Vec3f(world.space.point({0.01, 0.02, 3})), {0, 0, -1}};
  const Segment segment = world.medium.clip({ray});
  DepthProfile profile;
  profile.build(world.medium, segment, cutoff);
  return static_cast<double>(emission_along(world.medium, segment, profile, cutoff).y);
}

const Vec3<int> one_cell{1, 1, 1};

MemoryScene cube(double extinction) {
  MemoryScene scene;
  scene.add_box(Vec3d(-0.5), Vec3d(0.5)).extinction = extinction;
  return scene;
}

TEST(EmissionIntegral, ConstantEmitter) {
  // Deep media have a skin that single precision resolves ever less
  // (docs/developer/extreme-scenes.md).
  for (const auto& [sigma, tolerance] :
       {std::pair(0.0, 3e-5),
        {1e-3, 3e-5},
        {0.1, 3e-5},
        {1.0, 3e-5},
        {7.0, 3e-5},
        {100.0, 3e-5},
        {1e4, 2e-4},
        {1e6, 0.1},
        {2e6, 0.5}}) { // no medium is tracked at more (docs/developer/extreme-scenes.md)
    for (const bool brick : {false, true}) {
      MemoryScene scene = cube(sigma);
      DensityField field = brick ? closed_field(one_cell, [](int, int, int) { return 2.0; })
                                 : uniform_field(one_cell, 2);
      scene.glow(std::move(field), box_map(one_cell, Vec3d(-0.5), Vec3d(0.5))).scale = 1.5;
      const double expected = 3 * (sigma > 0 ? -std::expm1(-sigma) / sigma : 1);
      EXPECT_NEAR(along_z(scene) / expected, 1, tolerance)
          << sigma << (brick ? " brick" : " uniform");
    }
  }
}

/// j = s along the ray: the integral of s exp(-sigma s) from 0 to 1.
TEST(EmissionIntegral, LinearEmitter) {
  for (const double sigma : {0.0, 0.1, 1.0, 7.0, 100.0}) {
    MemoryScene scene = cube(sigma);
    scene.glow(closed_field(one_cell, [](int, int, int k) { return (8 - k) / 8.0; }),
               box_map(one_cell, Vec3d(-0.5), Vec3d(0.5)));
    const double expected =
        sigma > 0 ? (1 - std::exp(-sigma) * (1 + sigma)) / (sigma * sigma) : 0.5;
    EXPECT_NEAR(along_z(scene) / expected, 1, 3e-5) << sigma;
  }
}

/// What glows in front of the smoke, in it and behind it, and where there is none at all.
TEST(EmissionIntegral, FlameLongerThanTheSmoke) {
  MemoryScene scene = cube(2);
  scene.glow(uniform_field(one_cell, 1), box_map(one_cell, {-1, -1, -2}, {1, 1, 1.5}));
  const double behind = 1.5 * std::exp(-2), inside = (1 - std::exp(-2)) / 2;
  EXPECT_NEAR(along_z(scene) / (1 + inside + behind), 1, 3e-5);
  scene.scene.volumes[0].extinction = 0;
  EXPECT_NEAR(along_z(scene), 3.5, 1e-4);
}

TEST(EmissionIntegral, ChromaticExtinctionAndOverlap) {
  MemoryScene scene = cube(3);
  scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0.1f};
  scene.add_box({-0.5, -0.5, 0}, Vec3d(0.5)).extinction = 4;
  scene.glow(uniform_field(one_cell, 1), box_map(one_cell, {-1, -1, -1}, {1, 1, -0.5}));
  EXPECT_NEAR(along_z(scene) / (0.5 * std::exp(-0.5 * 3 - 0.5 * 4)), 1, 3e-5);
}

/// Lattices of density and emission that are turned against each other, against quadrature in
/// double precision by fields that share no code with the renderer.
TEST(EmissionIntegral, RandomFieldsOnDifferentLattices) {
  const Vec3<int> cells{2, 2, 2};
  const auto density = [](int i, int j, int k) { return lattice_noise(i, j, k, 1); };
  const auto light = [](int i, int j, int k) { return lattice_noise(i, j, k, 2); };
  const ExactField exact_density(cells, density), exact_light(cells, light);
  const Affine density_map = box_map(cells, Vec3d(-0.5), Vec3d(0.5));
  const Affine light_map =
      turn({1, 2, 3}, 40).after(box_map(cells, {-0.4, -0.4, -0.3}, {0.4, 0.5, 0.6}));
  const Affine to_density = density_map.inverse(), to_light = light_map.inverse();
  for (const double sigma : {0.5, 5.0, 50.0, 2000.0})
    for (const Vec3d& direction : {Vec3d{0.3, 0.2, -1}, {-0.1, 0.35, -1}, {0.01, -0.2, -1}}) {
      MemoryScene scene;
      scene.add(closed_field(cells, density), density_map).extinction = sigma;
      scene.glow(closed_field(cells, light), light_map);
      const World world = scene.world();
      const Vec3d origin = Vec3d(0.03, 0.01, 0) - direction * 2.0;
      const Ray ray{Vec3f(world.space.point(origin)), Vec3f(normalize(direction))};
      const Segment segment = world.medium.clip({ray});
      DepthProfile profile;
      profile.build(world.medium, segment, cutoff);
      const double result =
          static_cast<double>(emission_along(world.medium, segment, profile, cutoff).x);
      const Vec3d d = normalize(direction);
      constexpr int steps = 200000;
      double tau = 0, sum = 0;
      for (int i = 0; i < steps; ++i) { // the midpoint rule
        const double step = 4.0 / steps;
        const Vec3d p = origin + d * ((i + 0.5) * step);
        const double piece = sigma * exact_density.density(to_density.point(p)) * step;
        sum += exact_light.density(to_light.point(p)) * std::exp(-tau - 0.5 * piece) * step;
        tau += piece;
      }
      EXPECT_NEAR(result / sum, 1, 2e-4) << sigma;
    }
}

/// The estimate of a walk's flight has the right mean.
TEST(EmissionSamples, AreUnbiased) {
  const Vec3<int> cells{2, 2, 2};
  const auto light = [](int i, int j, int k) {
    const double u = lattice_noise(i, j, k, 3);
    return i < 8 && j < 8 ? 0.0 : u * u;
  };
  MemoryScene scene;
  scene.add_box(Vec3d(-0.5), Vec3d(0.5)).extinction = 1;
  scene.glow(closed_field(cells, light), box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  const World world = scene.world();
  const Ray ray{{-0.45f, -0.2f, 0.4f}, normalize(Vec3f{1, 0.5f, -0.7f})};
  const double expected = static_cast<double>(
      emission_along(world.medium, {ray, 0.1f, 0.9f}, DepthProfile(), cutoff).x);
  Samples samples;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    Rng rng({}, RngStage::test, i);
    samples.add(static_cast<double>(sample_emission(world.medium, {ray, 0.1f, 0.9f}, rng).x));
  }
  expect_mean(samples, expected);
  EXPECT_LT(samples.error(), 0.005 * expected);
}

} // namespace
} // namespace vdbeam
