#include "film/clamp.h"

#include <gtest/gtest.h>

#include <limits>

namespace vdbeam {
namespace {

PassImage two_pixels() {
  PassImage pass;
  pass.resize(2, 1);
  pass.direct = {{0.25f, 0.5f, 0.125f}, {1, 2, 3}};
  pass.indirect = {{0.25f, 0.5f, 0.125f}, {7, 14, 1}};
  pass.background = {{9, 9, 9}, {0.5f, 0.5f, 0.5f}};
  return pass;
}

TEST(Clamp, DimsBrightPixelsAndReportsTheLightRemoved) {
  PassImage pass = two_pixels();
  const ClampTally tally = clamp_pass(pass, 4);
  // The first has 1 at most, whatever is seen through it; the second 16, so it keeps a quarter.
  EXPECT_EQ(pass.direct[0], two_pixels().direct[0]);
  EXPECT_EQ(pass.direct[1], Rgb(0.25f, 0.5f, 0.75f));
  EXPECT_EQ(pass.indirect[1], Rgb(1.75f, 3.5f, 0.25f));
  EXPECT_EQ(pass.background[1], two_pixels().background[1]);
  EXPECT_EQ(tally.pixels, 1u);
  EXPECT_DOUBLE_EQ(tally.removed, 0.75 * 28);
  EXPECT_DOUBLE_EQ(tally.total, 1.75 + 27 + 28 + 1.5);
}

TEST(Clamp, LeavesEverythingUnderTheLimit) {
  PassImage pass = two_pixels();
  const ClampTally tally = clamp_pass(pass, 16);
  EXPECT_EQ(pass.indirect[1], two_pixels().indirect[1]);
  EXPECT_EQ(tally.removed, 0);
  EXPECT_EQ(tally.pixels, 0u);
}

TEST(Clamp, LeavesValuesThatAreNotFiniteToTheFilm) {
  PassImage pass = two_pixels();
  pass.indirect[1].x = std::numeric_limits<float>::infinity();
  const ClampTally tally = clamp_pass(pass, 4);
  EXPECT_EQ(tally.pixels, 0u);
  EXPECT_DOUBLE_EQ(tally.total, 1.75 + 27);
}

} // namespace
} // namespace vdbeam
