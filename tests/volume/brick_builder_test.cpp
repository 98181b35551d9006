#include "vdb/brick_builder.h"

#include "vdbeam/error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>
#include <random>

namespace vdbeam {
namespace {

/// Leaves of a dense cube, as the reader hands them over.
struct Leaves {
  std::vector<std::int32_t> origins;
  std::vector<float> values;

  void add(std::int32_t x, std::int32_t y, std::int32_t z, float value) {
    origins.insert(origins.end(), {x, y, z});
    values.insert(values.end(), leaf_size, value);
  }
  RawGrid grid() {
    RawGrid grid;
    grid.leaf_count = origins.size() / 3;
    grid.leaf_origins = origins.data();
    grid.leaf_values = values.data();
    return grid;
  }
};

Leaves dense_noise(int width) {
  Leaves leaves;
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < width; ++y)
      for (int z = 0; z < width; ++z)
        leaves.add(8 * x - 24, 8 * y, 8 * z + 800, 0);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform;
  for (float& value : leaves.values)
    value = uniform(random);
  return leaves;
}

constexpr std::uint64_t gib = std::uint64_t(1) << 30;

TEST(BrickBuilder, dense_data_needs_at_most_twice_its_bytes) {
  Leaves leaves = dense_noise(24);
  RawGrid grid = leaves.grid();
  const DensityField field = build_bricks(grid, "label", gib).field;
  const std::size_t cells = static_cast<std::size_t>(field.cell_counts().x) *
                            field.cell_counts().y * field.cell_counts().z;
  EXPECT_EQ(field.brick_count(), 25u * 25 * 25) << "one layer more below";
  EXPECT_LE(field.bytes(), 2 * leaves.values.size() * sizeof(float) + cells * 2 * sizeof(float));
}

TEST(BrickBuilder, threads_do_not_change_a_bit) {
  const auto build = [](std::size_t threads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Leaves leaves = dense_noise(20);
    for (std::size_t i = 0; i < leaves.values.size(); i += 7)
      leaves.values[i] = i % 3 == 0 ? -1 : 0;
    RawGrid grid = leaves.grid();
    grid.tiles.push_back({{128, 0, 800}, 128, 0.5f});
    return build_bricks(grid, "label", gib);
  };
  const BrickedGrid one = build(1), four = build(4);
  ASSERT_EQ(one.field.brick_count(), four.field.brick_count());
  EXPECT_EQ(one.repairs.negative, four.repairs.negative);
  EXPECT_EQ(one.field.maximum(), four.field.maximum());
  EXPECT_EQ(one.field.occupied().upper, four.field.occupied().upper);
  EXPECT_EQ(std::memcmp(one.field.brick(0), four.field.brick(0),
                        one.field.brick_count() * DensityField::brick_size * sizeof(float)),
            0);
  const Vec3<int> counts = one.field.cell_counts();
  ASSERT_EQ(counts, four.field.cell_counts());
  for (int i = 0; i < counts.x; ++i)
    for (int j = 0; j < counts.y; ++j)
      for (int k = 0; k < counts.z; ++k)
        ASSERT_EQ(one.field.cell(i, j, k), four.field.cell(i, j, k));
}

TEST(BrickBuilder, releases_leaves_as_it_goes) {
  Leaves leaves = dense_noise(24);
  RawGrid grid = leaves.grid();
  std::vector<std::size_t> released;
  grid.release = [&released](std::size_t count) { released.push_back(count); };
  build_bricks(grid, "label", gib);
  ASSERT_GE(released.size(), 3u);
  EXPECT_TRUE(std::is_sorted(released.begin(), released.end()));
  EXPECT_GT(released[1], 0u);
  EXPECT_LT(released[1], grid.leaf_count);
  EXPECT_GE(released.back(), grid.leaf_count - 24 * 24);
}

TEST(BrickBuilder, zeros_and_equal_values_need_no_bricks) {
  Leaves leaves;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z)
        leaves.add(8 * x, 8 * y, 8 * z, 2);
  leaves.add(800, 0, 0, 0);
  RawGrid grid = leaves.grid();
  const DensityField field = build_bricks(grid, "label", gib).field;
  EXPECT_EQ(field.cell_counts(), Vec3<int>(5, 5, 5)) << "the leaf of zeros takes no room";
  EXPECT_EQ(field.brick_count(), 125u - 27u);
  EXPECT_LT(field.cell(2, 2, 2), DensityField::empty_cell);
  EXPECT_EQ(field.origin(), Vec3<std::int64_t>(-8, -8, -8));
}

TEST(BrickBuilder, refuses_what_cannot_fit) {
  Leaves leaves;
  leaves.add(-2147483648, 0, 0, 1);
  leaves.add(2147483640, 2147483640, 2147483640, 1);
  RawGrid grid = leaves.grid();
  try {
    build_bricks(grid, "x.vdb: grid \"d\"", gib);
    FAIL() << "no FrameError";
  } catch (const FrameError& error) {
    EXPECT_STREQ(error.what(),
                 "x.vdb: grid \"d\": its voxels span 4294967304 x 2147483656 x 2147483656, more "
                 "than the 2^28 blocks of 8^3 that fit in the index table; crop the grid or split "
                 "it in several volumes");
  }
  Leaves noise = dense_noise(8);
  RawGrid small = noise.grid();
  EXPECT_THROW(build_bricks(small, "label", 1 << 20), FrameError);
  Leaves apart;
  apart.add(0, 0, 0, 1);
  apart.add(8 * 200, 8 * 200, 8 * 200, 1);
  RawGrid sparse = apart.grid();
  EXPECT_THROW(build_bricks(sparse, "label", 1 << 20), FrameError)
      << "the index table is too large";
}

TEST(BrickBuilder, nothing_gives_an_empty_field) {
  RawGrid none;
  EXPECT_TRUE(build_bricks(none, "label", gib).field.empty());
  Leaves zeros;
  zeros.add(0, 0, 0, 0);
  RawGrid grid = zeros.grid();
  grid.tiles.push_back({{0, 0, 8}, 8, -1});
  const BrickedGrid result = build_bricks(grid, "label", gib);
  EXPECT_TRUE(result.field.empty());
  EXPECT_EQ(result.repairs.negative, 512u);
}

} // namespace
} // namespace vdbeam
