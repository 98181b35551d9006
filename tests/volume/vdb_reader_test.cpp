#include "volume/vdb_reader.h"

#include "support/make_field.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(MakeField, holds_what_the_function_says) {
  const DensityField field =
      test::make_field(20, 9, 8, [](int i, int j, int k) { return i + 100 * j + 10000 * k; });
  EXPECT_EQ(field.sample({3.5f, 2, 1}), 10203.5f);
  EXPECT_EQ(field.sample({19, 8, 7}), 70819);
  EXPECT_EQ(field.maximum(), 70819);
  EXPECT_EQ(field.occupied().upper, Vec3f(20, 9, 8));
}

} // namespace
} // namespace vdbeam
