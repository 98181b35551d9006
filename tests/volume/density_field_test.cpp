#include "volume/density_field.h"

#include "support/make_field.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace vdbeam {
namespace {

TEST(DensityField, interpolates_between_lattice_points) {
  const DensityField field =
      test::make_field(20, 9, 8, [](int i, int j, int k) { return i + 100 * j + 10000 * k; });
  EXPECT_EQ(field.sample({3.5f, 2, 1}), 10203.5f);
  EXPECT_EQ(field.sample({7.75f, 7.5f, 3.25f}), 7.75f + 750 + 32500);
  EXPECT_EQ(field.sample({19, 8, 7}), 70819);
  EXPECT_EQ(field.sample({19.5f, 8, 7}), 70819 / 2.0f);
  EXPECT_EQ(field.maximum(), 70819);
}

TEST(DensityField, is_zero_outside) {
  const DensityField field = test::make_field(8, 8, 8, [](int, int, int) { return 3; });
  EXPECT_EQ(field.sample({4, 4, 4}), 3);
  EXPECT_EQ(field.sample({-1e-6f, 4, 4}), 0);
  EXPECT_EQ(field.sample({4, 8, 4}), 0);
  EXPECT_EQ(field.sample({4, 4, 1e30f}), 0);
  EXPECT_EQ(field.sample({4, std::nanf(""), 4}), 0);
  EXPECT_EQ(DensityField().sample({0, 0, 0}), 0);
}

TEST(DensityField, empty_has_an_empty_box) {
  EXPECT_TRUE(DensityField().empty());
  EXPECT_TRUE(DensityField().occupied().empty());
  const DensityField zeros = test::make_field(16, 16, 16, [](int, int, int) { return 0; });
  EXPECT_TRUE(zeros.occupied().empty());
  EXPECT_EQ(zeros.maximum(), 0);
  EXPECT_EQ(zeros.brick_count(), 0u);
}

TEST(DensityField, box_is_tight) {
  const DensityField one = test::make_field(
      24, 24, 24, [](int i, int j, int k) { return i == 9 && j == 15 && k == 8 ? 1 : 0; });
  EXPECT_EQ(one.occupied().lower, Vec3f(8, 14, 7));
  EXPECT_EQ(one.occupied().upper, Vec3f(10, 16, 9));
  EXPECT_EQ(one.sample({8.5f, 15, 8}), 0.5f);
  EXPECT_EQ(one.sample({9, 15, 7.25f}), 0.25f);
}

TEST(DensityField, box_of_uniform_cells) {
  const DensityField field =
      test::make_field(25, 25, 25, [](int i, int, int) { return i >= 8 && i <= 16 ? 2 : 0; });
  EXPECT_LT(field.cell(1, 1, 1), DensityField::empty_cell) << "not uniform";
  EXPECT_EQ(field.occupied().lower, Vec3f(7, 0, 0));
  EXPECT_EQ(field.occupied().upper, Vec3f(17, 25, 25));
}

TEST(DensityField, no_sample_exceeds_its_cells_maximum) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> values(30 * 30 * 30);
  for (float& value : values)
    value = uniform(random);
  const DensityField field = test::make_field(
      30, 30, 30, [&](int i, int j, int k) { return values[(i * 30 + j) * 30 + k]; });
  float largest_share = 0;
  for (int n = 0; n < 100000; ++n) {
    const Vec3f at{31 * uniform(random), 31 * uniform(random), 31 * uniform(random)};
    const std::size_t cell = field.cell_offset(
        static_cast<int>(at.x) / 8, static_cast<int>(at.y) / 8, static_cast<int>(at.z) / 8);
    ASSERT_LE(field.sample(at), field.cell_maximum(cell));
    largest_share = std::max(largest_share, field.sample(at) / field.cell_maximum(cell));
  }
  EXPECT_GT(largest_share, 0.9f);
  EXPECT_EQ(field.maximum(), *std::max_element(values.begin(), values.end()));
}

TEST(DensityField, refuses_parts_that_do_not_fit) {
  EXPECT_THROW(DensityField({0, 0, 0}, {2, 1, 1}, {0}, std::vector<float>(729), {}),
               std::invalid_argument);
  EXPECT_THROW(DensityField({0, 0, 0}, {1, 1, 1}, {0}, std::vector<float>(512), {}),
               std::invalid_argument);
}

} // namespace
} // namespace vdbeam
