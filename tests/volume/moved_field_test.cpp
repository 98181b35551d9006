#include "grids/moved_field.h"

#include "support/make_field.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr int size = 32;
const Vec3d center{15.3, 16.1, 14.7};

/// A smooth ball of radius 8 voxels, 0 outside.
double ball(const Vec3d& p, const Vec3d& middle = center) {
  const double s = dot(p - middle, p - middle) / 64;
  return s < 1 ? (1 - s) * (1 - s) * (1 - s) : 0;
}

DensityGrid ball_grid(double voxel = 1) {
  DensityGrid grid;
  grid.field = test::make_field(size, size, size, [](int i, int j, int k) {
    return ball({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
  });
  for (int a = 0; a < 3; ++a)
    grid.index_to_world.rows[static_cast<std::size_t>(a)] *= voxel;
  grid.active_voxels = 1;
  return grid;
}

/// Velocities at the voxels of the lattice for which `inside` holds, `value` being that at a point.
template <class Value, class Inside>
VectorField velocities(Value value, Inside inside, bool staggered = false, double voxel = 1) {
  VectorField::Values values;
  for (int a = 0; a < 3; ++a)
    values.index_to_world.rows[static_cast<std::size_t>(a)] *= voxel;
  values.staggered = staggered;
  values.cells = {size / 8, size / 8, size / 8};
  for (int cell = 0; cell < 4 * 4 * 4; ++cell) {
    values.table.push_back(cell);
    for (int v = 0; v < 512; ++v) {
      const Vec3d p{cell / 16 * 8.0 + v / 64, cell / 4 % 4 * 8.0 + v / 8 % 8,
                    cell % 4 * 8.0 + v % 8};
      Vec3f velocity(std::numeric_limits<float>::quiet_NaN());
      for (int c = 0; c < 3 && inside(p); ++c) {
        Vec3d at = p;
        at[c] -= staggered ? 0.5 : 0;
        velocity[c] = static_cast<float>(value(at)[c]);
      }
      values.bricks.push_back(velocity);
    }
  }
  return {std::move(values), 1e6};
}

const auto everywhere = [](const Vec3d&) { return true; };
const auto in_the_ball = [](const Vec3d& p) { return length(p - center) < 9; };

/// The value of the moved field at an index.
float moved_value_at(const DensityGrid& grid, const Vec3d& index) {
  return grid.field.sample(Vec3f(index - Vec3d(grid.field.origin())));
}

double mass(const DensityGrid& grid, const Vec3d& lower = Vec3d(-60),
            const Vec3d& upper = Vec3d(90)) {
  double sum = 0;
  for (double x = lower.x; x <= upper.x; ++x)
    for (double y = lower.y; y <= upper.y; ++y)
      for (double z = lower.z; z <= upper.z; ++z)
        sum += static_cast<double>(moved_value_at(grid, {x, y, z}));
  return sum;
}

DensityGrid moved(const VectorField& velocity, double time, double voxel = 1,
                  VelocityUnits units = VelocityUnits::world) {
  VelocitySettings settings;
  settings.time = time;
  settings.units = units;
  return moved_grid(ball_grid(voxel), {velocity, settings}, "memory", std::uint64_t{1} << 30);
}

/// A ball whose velocity is known in it alone leaves the place where it was, voxel by voxel.
TEST(MovedField, TranslatesABall) {
  const Vec3d v{13, -6, 27};
  const VectorField velocity = velocities([&](const Vec3d&) { return v; }, in_the_ball);
  const DensityGrid still = ball_grid();
  for (const double time : {1.0, -1.0}) {
    const DensityGrid grid = moved(velocity, time);
    for (int i = 0; i < size; i += 3)
      for (int j = 0; j < size; j += 2)
        for (int k = 0; k < size; ++k) {
          const Vec3d p{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
          ASSERT_EQ(moved_value_at(grid, p + v * time), moved_value_at(still, p))
              << i << " " << j << " " << k;
        }
    EXPECT_NEAR(mass(grid), mass(still), 1e-6 * mass(still));
  }
}

/// Between voxels values are interpolated: the sum stays, and the ball is blurred by less than the
/// second differences that linear interpolation neglects.
TEST(MovedField, KeepsMassBetweenVoxels) {
  const Vec3d v{3.4, 0.25, -7.9};
  const VectorField velocity = velocities([&](const Vec3d&) { return v; }, in_the_ball);
  const DensityGrid still = ball_grid(), grid = moved(velocity, 0.5);
  EXPECT_NEAR(mass(grid), mass(still), 1e-6 * mass(still));
  double worst = 0;
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      const Vec3d p{static_cast<double>(i), static_cast<double>(j), 11};
      worst = std::max(worst, std::abs(static_cast<double>(moved_value_at(grid, p)) -
                                       ball(p, center + v * 0.5)));
    }
  EXPECT_LT(worst, 3 * 6.0 / 64 / 8); // three axes of |f''| / 8, f'' = 6 / 64 at the middle
}

/// v = w x (p - c): every point goes along its tangent, p' = (1 + t W) (p - c) + c.
TEST(MovedField, TurnsByTheTangent) {
  const double turn = 0.3;
  const auto spin = [&](const Vec3d& p) { return cross(Vec3d(0, 0, turn), p - Vec3d(16, 16, 16)); };
  const DensityGrid grid = moved(velocities(spin, everywhere), 1);
  const double stretch = 1 + turn * turn;
  double worst = 0, sum = 0;
  for (int i = 2; i < size - 2; ++i)
    for (int j = 2; j < size - 2; ++j)
      for (int k = 2; k < size - 2; ++k) {
        const Vec3d q = Vec3d(Vec3<int>{i, j, k}) - Vec3d(16, 16, 16);
        // (1 + W)^-1 of the plane: (x + turn y, y - turn x) / (1 + turn^2)
        const Vec3d source{(q.x + turn * q.y) / stretch, (q.y - turn * q.x) / stretch, q.z};
        const double expected = ball(source + Vec3d(16, 16, 16));
        worst = std::max(
            worst,
            std::abs(static_cast<double>(moved_value_at(grid, q + Vec3d(16, 16, 16))) - expected));
        sum += expected;
      }
  EXPECT_GT(sum, 100);
  EXPECT_LT(worst, 0.045); // interpolation 0.035, and the fixed point: 0.3^4 of the way
}

/// Where components lie does not matter to what they say.
TEST(MovedField, StaggeredComponentsAreSampledWhereTheyLie) {
  const auto flow = [](const Vec3d& p) {
    return Vec3d{0.2 * p.x + 0.1 * p.y, 3 - 0.1 * p.x, 0.15 * p.z - 0.05 * p.y};
  };
  const VectorField centred = velocities(flow, everywhere);
  const VectorField staggered = velocities(flow, everywhere, true);
  for (const Vec3d& p : {Vec3d(9.3, 17.2, 20.9), Vec3d(4, 5, 6), Vec3d(22.75, 8.5, 13.1)}) {
    EXPECT_LT(length(centred.sample(p) - flow(p)), 1e-5);
    EXPECT_LT(length(staggered.sample(p) - flow(p)), 1e-5);
  }
}

/// On a lattice finer than that of the velocity, ways are found where the latter has points. The
/// reference has the same velocities at every point of the density's lattice.
TEST(MovedField, WaysBetweenThePointsOfACoarseVelocity) {
  for (const int coarse : {2, 4}) {
    const auto flow = [](const Vec3d& p) {
      return Vec3d{4 * std::sin(p.y / 8), 4 * std::cos(p.x / 8), 4 * std::sin(p.z / 8)};
    };
    const VectorField velocity = velocities(
        [&](const Vec3d& index) { return flow(index * coarse); }, everywhere, false, coarse);
    const VectorField at_each_point =
        velocities([&](const Vec3d& index) { return velocity.sample(index / coarse); }, everywhere);
    const DensityGrid between = moved(velocity, 1), found = moved(at_each_point, 1);
    double worst = 0, change = 0;
    for (int i = 4; i < size - 4; ++i)
      for (int j = 4; j < size - 4; ++j)
        for (int k = 4; k < size - 4; ++k) {
          const Vec3d p(Vec3<int>{i, j, k});
          const auto value = static_cast<double>(moved_value_at(found, p));
          worst =
              std::max(worst, std::abs(static_cast<double>(moved_value_at(between, p)) - value));
          change = std::max(change, std::abs(value - ball(p)));
        }
    EXPECT_GT(change, 0.2);
    // Interpolated, each component of a way is off by h^2 / 8 times its second derivative, 4 / 64
    // where the flow is not squeezed and up to twice that here; the ball's slope is 0.21 at most.
    EXPECT_LT(worst, 0.21 * std::sqrt(3) * coarse * coarse / 8 * 2 * 4 / 64) << coarse;
    EXPECT_GT(worst, 0) << coarse;
  }
}

TEST(MovedField, UnitsOfTheWorldAndOfTheIndex) {
  const VectorField velocity =
      velocities([](const Vec3d&) { return Vec3d(2, 0, 0); }, everywhere, false, 0.25);
  const Vec3d top{15, 16, 15};
  const DensityGrid still = ball_grid(0.25);
  EXPECT_EQ(moved_value_at(moved(velocity, 1, 0.25), top + Vec3d(8, 0, 0)),
            moved_value_at(still, top));
  EXPECT_EQ(moved_value_at(moved(velocity, 1, 0.25, VelocityUnits::index), top + Vec3d(2, 0, 0)),
            moved_value_at(still, top));
}

TEST(MovedField, StandsStillWithoutTimeOrVelocity) {
  const VectorField velocity = velocities([](const Vec3d&) { return Vec3d(5, 5, 5); }, everywhere);
  const DensityGrid same = moved(velocity, 0), still = ball_grid();
  ASSERT_EQ(same.field.brick_count(), still.field.brick_count());
  for (int i = 0; i < size; ++i)
    EXPECT_EQ(moved_value_at(same, {static_cast<double>(i), 16, 15}),
              moved_value_at(still, {static_cast<double>(i), 16, 15}));
  const VectorField nothing =
      velocities([](const Vec3d&) { return Vec3d(5, 5, 5); }, [](const Vec3d&) { return false; });
  EXPECT_EQ(mass(moved(nothing, 1)), mass(still));
}

/// Velocities that are not to be trusted are counted and replaced by those around.
TEST(MovedField, OutliersMoveLikeTheirNeighbours) {
  const auto flow = [](const Vec3d& p) {
    if (p == Vec3d(15, 16, 15))
      return Vec3d(std::numeric_limits<double>::infinity(), 0, 0);
    return p == Vec3d(14, 16, 15) ? Vec3d(1e7, 0, 0) : Vec3d(4, 0, 0);
  };
  const VectorField velocity = velocities(flow, everywhere);
  EXPECT_EQ(velocity.outliers(), 2);
  const DensityGrid grid = moved(velocity, 1), still = ball_grid();
  for (int i = 4; i < size; ++i)
    EXPECT_EQ(moved_value_at(grid, {i + 4.0, 16, 15}),
              moved_value_at(still, {static_cast<double>(i), 16, 15}));
}

TEST(ReadVelocity, FindsItByItsName) {
  const test::TempFolder folder;
  const std::string path = folder.file("smoke.vdb");
  VolumeOptions options;
  options.size = 24;
  write_volume("simulation", path, options);
  VelocitySettings settings;
  const auto velocity = read_velocity(path, settings);
  ASSERT_TRUE(velocity);
  EXPECT_FALSE(velocity->empty());
  settings.grid = "density";
  EXPECT_THROW(read_velocity(path, settings), InputError);
  settings.grid = "velocity";
  EXPECT_TRUE(read_velocity(path, settings));
  write_volume("sphere", path, options);
  settings.grid = "auto";
  EXPECT_EQ(read_velocity(path, settings), nullptr);
}

TEST(ReadVelocity, StaggeredAndInThreeGrids) {
  const test::TempFolder folder;
  const std::string path = folder.file("moving.vdb");
  VolumeOptions options;
  options.size = 24;
  for (const char* kind : {"staggered", "components"}) {
    write_volume(kind, path, options);
    VelocitySettings settings;
    const auto velocity = read_velocity(path, settings);
    ASSERT_TRUE(velocity);
    EXPECT_EQ(velocity->outliers(), 0);
    EXPECT_LT(length(velocity->sample({0, 0, 0}) - Vec3d(1, 2, 3)), 1e-6);
    EXPECT_LT(length(velocity->sample({100, 0, -100}) - Vec3d(1, 2, 3)), 1e-6);
    settings.time = 0.5;
    const DensityGrid still = read_density_grid(path, "density");
    const DensityGrid moved = moved_grid(still, {*velocity, settings}, path, 1 << 30);
    const Vec3d by = still.index_to_world.inverse().vector({0.5, 1, 1.5});
    const auto value = [](const DensityGrid& grid, const Vec3d& index) {
      return grid.field.sample(Vec3f(index - Vec3d(grid.field.origin())));
    };
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(8, 0, 0), Vec3d(0, -7, 3), Vec3d(14, 0, 0)})
      EXPECT_NEAR(value(moved, p + by), value(still, p), 1e-5) << kind;
  }
}

/// Rays need not look into cells that nothing came to.
TEST(MovedField, HasNoEmptyBricks) {
  const DensityGrid grid = ball_grid();
  VelocitySettings settings;
  settings.time = 1;
  const VectorField flow = velocities([](const Vec3d&) { return Vec3d(13, -9, 5); }, everywhere);
  const DensityGrid moved = moved_grid(grid, {flow, settings}, "ball", 1 << 30);
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  EXPECT_THROW(moved_grid(grid, {flow, settings}, "ball", {1 << 30, &stop}), Stopped);
  const DensityField& field = moved.field;
  for (std::size_t brick = 0; brick < field.brick_count(); ++brick) {
    const float* values = field.brick(static_cast<std::int32_t>(brick));
    EXPECT_TRUE(std::any_of(values, values + DensityField::brick_size,
                            [](float value) { return value != 0; }));
  }
  EXPECT_LE(field.brick_count(), 64u); // the ball is 16 voxels wide
  EXPECT_NEAR(mass(moved), mass(grid), 0.01 * mass(grid));
}

} // namespace
} // namespace vdbeam
