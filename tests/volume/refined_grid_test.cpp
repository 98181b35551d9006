#include "grids/refined_grid.h"

#include "support/make_field.h"
#include "support/memory_scene.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

constexpr std::uint64_t enough_memory = std::uint64_t(1) << 30;

template <class Value>
DensityGrid grid_of(Value value) {
  DensityGrid grid;
  grid.field = test::make_field(20, 17, 22, value);
  grid.index_to_world.rows[0] *= 0.5;
  grid.index_to_world.rows[2] *= 3;
  grid.index_to_world.translation = {-3, 1, 10};
  grid.active_voxels = 1;
  return grid;
}

/// The value at a point of the world.
double sample(const DensityGrid& grid, const Vec3d& world) {
  const Vec3d index = grid.index_to_world.inverse().point(world);
  return static_cast<double>(grid.field.sample(Vec3f(index - Vec3d(grid.field.origin()))));
}

/// The uniform cubic B-spline's weight of a lattice point at a distance.
double spline(double x) {
  const double a = std::abs(x);
  if (a >= 2)
    return 0;
  return a < 1 ? 2.0 / 3 - a * a + a * a * a / 2 : (2 - a) * (2 - a) * (2 - a) / 6;
}

/// The definition, at an index point.
double spline_at(const DensityGrid& grid, const Vec3d& index) {
  double sum = 0;
  const Vec3d first{std::floor(index.x), std::floor(index.y), std::floor(index.z)};
  for (int i = -2; i <= 2; ++i)
    for (int j = -2; j <= 2; ++j)
      for (int k = -2; k <= 2; ++k) {
        const Vec3d p = first + Vec3d(Vec3<int>{i, j, k}), d = index - p;
        sum += spline(d.x) * spline(d.y) * spline(d.z) *
               static_cast<double>(grid.field.sample(Vec3f(p - Vec3d(grid.field.origin()))));
      }
  return sum;
}

double noise(int i, int j, int k) {
  return (i + j) % 5 == 0 ? 0.0 : test::lattice_noise(i, j, k);
}

TEST(RefinedGrid, IsTheSplineAtEveryPointOfItsLattice) {
  const DensityGrid grid = grid_of(noise);
  const DensityGrid fine = refined_grid(grid, "a.vdb", enough_memory);
  double largest = 0;
  for (int i = -5; i < 46; ++i)
    for (int j = -5; j < 40; ++j)
      for (int k = -5; k < 50; ++k) {
        const Vec3d index = Vec3d(Vec3<int>{i, j, k}) * 0.5;
        const double expected = spline_at(grid, index);
        ASSERT_NEAR(sample(fine, grid.index_to_world.point(index)), expected, 2e-6)
            << i << " " << j << " " << k;
        largest = std::max(largest, expected);
      }
  EXPECT_GT(largest, 0.3);
  EXPECT_LE(fine.field.maximum(), grid.field.maximum());
}

/// As much lies in it, and no plane of the old lattice has a kink.
TEST(RefinedGrid, KeepsTheMassAndIsSmooth) {
  const DensityGrid grid = grid_of(noise);
  const DensityGrid fine = refined_grid(grid, "a.vdb", enough_memory);
  double before = 0, after = 0;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 17; ++j)
      for (int k = 0; k < 22; ++k)
        before += static_cast<double>(grid.field.sample(Vec3f(Vec3<int>{i, j, k})));
  const Vec3<int> n = fine.field.cell_counts() * 8;
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k)
        after += static_cast<double>(fine.field.sample(Vec3f(Vec3<int>{i, j, k})));
  EXPECT_NEAR(after / 8, before, 1e-4 * before);
}

TEST(RefinedGrid, RefusesMoreMemoryThanThereIs) {
  EXPECT_THROW(refined_grid(grid_of(noise), "a.vdb", 1000), FrameError);
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  EXPECT_THROW(refined_grid(grid_of(noise), "a.vdb", {enough_memory, &stop}), Stopped);
}

TEST(RefinedGrid, OfNothingIsNothing) {
  EXPECT_TRUE(refined_grid(DensityGrid{}, "a.vdb", enough_memory).field.empty());
}

} // namespace
} // namespace vdbeam
