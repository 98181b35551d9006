#include "grids/combined_grid.h"

#include "math/rng.h"
#include "support/make_field.h"
#include "vdbeam/error.h"
#include "volume/noise.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

/// A cube of ones, 16 lattice points wide, in a world in which a voxel is 0.5 wide.
DensityGrid cube(double at = 0, double voxel = 0.5) {
  DensityGrid grid;
  grid.field = test::make_field(
      17, 17, 17, [](int i, int j, int k) { return i > 0 && j > 0 && k > 0 ? 1.0 : 0.0; });
  for (int a = 0; a < 3; ++a)
    grid.index_to_world.rows[static_cast<std::size_t>(a)] *= voxel;
  grid.index_to_world.translation = Vec3d(at);
  grid.active_voxels = 16 * 16 * 16;
  return grid;
}

float value_at(const DensityGrid& grid, const Vec3d& world) {
  const Vec3d index = grid.index_to_world.inverse().point(world);
  return grid.field.sample(Vec3f(index - Vec3d(grid.field.origin())));
}

TEST(GradientNoise, StaysInItsBoundsAndIsZeroAtTheLattice) {
  Rng rng({1, 0, 0}, RngStage::test, 0);
  double least = 0, most = 0, sum = 0, squares = 0;
  constexpr int count = 200000;
  for (int i = 0; i < count; ++i) {
    const Vec3d p(static_cast<double>(rng.uniform()) * 200 - 100,
                  static_cast<double>(rng.uniform()) * 200 - 100,
                  static_cast<double>(rng.uniform()) * 200 - 100);
    const double value = gradient_noise(p, 7);
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    squares += value * value;
  }
  EXPECT_GE(least, -1);
  EXPECT_LE(most, 1);
  EXPECT_GT(most - least, 1.4); // and uses them
  EXPECT_NEAR(sum / count, 0, 0.01);
  EXPECT_NEAR(std::sqrt(squares / count), 0.26, 0.05); // what Perlin's noise has
  for (int i = -5; i < 5; ++i)
    EXPECT_EQ(gradient_noise({static_cast<double>(i), 3, -2}, 7), 0);
}

TEST(GradientNoise, IsSmoothAndSeeded) {
  double largest = 0;
  int same = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p(0.013 * i, 0.007 * i + 0.5, 0.3);
    largest = std::max(largest, std::abs(gradient_noise(p + Vec3d(1e-4, 0, 0), 1) -
                                         gradient_noise(p - Vec3d(1e-4, 0, 0), 1)));
    same += gradient_noise(p, 1) == gradient_noise(p, 2);
  }
  EXPECT_LT(largest, 4 * 2e-4); // no steps
  EXPECT_LT(same, 10);
}

/// Every value is one of the field's within the amplitude, and the bricks bound what lies between.
TEST(DisplacedGrid, MovesByTheAmplitudeAtMostAndKeepsItsBounds) {
  const DensityGrid grid = cube();
  const NoiseSettings noise{1.5, 2, 4, 3};
  const DensityGrid moved = displaced_grid(grid, noise, "cube", 1 << 30);
  Rng rng({2, 0, 0}, RngStage::test, 0);
  const auto number = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(rng.uniform());
  };
  int changed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d world(number(-3, 12), number(-3, 12), number(-3, 12));
    const float value = value_at(moved, world);
    ASSERT_GE(value, 0);
    ASSERT_LE(value, 1);
    // The cube ends at 0 and 8.5, where its ramps do; lattice points lie up to a voxel away.
    const double reach = noise.amplitude + 0.5 + 1e-6;
    bool outside = false, inside = true;
    for (int a = 0; a < 3; ++a) {
      outside = outside || world[a] < -reach || world[a] > 8.5 + reach;
      inside = inside && world[a] > 0.5 + reach && world[a] < 8 - reach;
    }
    if (outside) {
      ASSERT_EQ(value, 0) << world.x << " " << world.y << " " << world.z;
    }
    if (inside) {
      ASSERT_NEAR(value, 1, 1e-6);
    }
    changed += std::abs(value - value_at(grid, world)) > 0.5f;
    const Vec3d local = moved.index_to_world.inverse().point(world) - Vec3d(moved.field.origin());
    const Vec3<int>& n = moved.field.cell_counts();
    if (value > 0) {
      ASSERT_LE(value, moved.field.cell_maximum(moved.field.cell_offset(
                           std::min(static_cast<int>(local.x) / 8, n.x - 1),
                           std::min(static_cast<int>(local.y) / 8, n.y - 1),
                           std::min(static_cast<int>(local.z) / 8, n.z - 1))));
    }
  }
  EXPECT_GT(changed, 50);
}

TEST(DisplacedGrid, LatticePointsShowWhatTheNoiseSays) {
  const DensityGrid grid = cube();
  const NoiseSettings noise{0.7, 3, 2, 1};
  const DensityGrid moved = displaced_grid(grid, noise, "cube", 1 << 30);
  for (int i = -3; i < 20; ++i)
    for (int j = -3; j < 20; ++j) {
      const Vec3d world = moved.index_to_world.point({double(i), double(j), 5.0});
      EXPECT_NEAR(value_at(moved, world), value_at(grid, world + noise_displacement(noise, world)),
                  1e-5);
    }
}

TEST(SumOfGrids, AddsGridsOfOtherLattices) {
  const DensityGrid a = cube(), b = cube(6, 0.25);
  const DensityGrid sum = sum_of_grids({a, b}, "cubes", 1 << 30);
  for (int i = -2; i < 30; ++i)
    for (int j = -2; j < 30; ++j) {
      const Vec3d world = sum.index_to_world.point({double(i), double(j), 14.0});
      EXPECT_NEAR(value_at(sum, world), value_at(a, world) + value_at(b, world), 1e-5);
    }
  EXPECT_EQ(sum.active_voxels, 2 * a.active_voxels);
  const DensityGrid only = sum_of_grids({DensityGrid(), b}, "cubes", 1 << 30);
  EXPECT_EQ(value_at(only, {8, 8, 8}), 1);
  EXPECT_TRUE(sum_of_grids({DensityGrid(), DensityGrid()}, "nothing", 1 << 30).field.empty());
}

TEST(SumOfGrids, RefusesWhatTakesTooMuch) {
  EXPECT_THROW(sum_of_grids({cube(), cube(6)}, "cubes", 1000), FrameError);
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  EXPECT_THROW(sum_of_grids({cube(), cube(6)}, "cubes", {1 << 30, &stop}), Stopped);
  EXPECT_THROW(displaced_grid(cube(), {0.1, 1, 1, 1}, "cube", {1 << 30, &stop}), Stopped);
  EXPECT_THROW(sum_of_grids({cube(), cube(1e7)}, "cubes", 1 << 30), FrameError);
  EXPECT_THROW(displaced_grid(cube(), {1e9, 1, 1, 1}, "cube", 1 << 30), FrameError);
}

} // namespace
} // namespace vdbeam
