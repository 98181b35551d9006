#include "text/curve.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(Curve, IsLinearBetweenItsPointsAndHoldsBeyond) {
  const Curve curve("-1:2 0:0  3:6", 1);
  EXPECT_EQ(curve.at(-5), 2);
  EXPECT_EQ(curve.at(-0.5), 1);
  EXPECT_EQ(curve.at(0), 0);
  EXPECT_EQ(curve.at(1), 2);
  EXPECT_EQ(curve.at(3), 6);
  EXPECT_EQ(curve.at(1e30), 6);
}

TEST(Curve, HoldsColours) {
  const Curve curve("0:1,0,0.5 10:0,2,0.5", 3);
  EXPECT_EQ(curve.at(5, 0), 0.5);
  EXPECT_EQ(curve.at(5, 1), 1);
  EXPECT_EQ(curve.at(5, 2), 0.5);
}

TEST(Curve, NamesTheMistake) {
  EXPECT_EQ(why_no_curve("", 1), "");
  EXPECT_EQ(why_no_curve("0:1 1:2", 1), "");
  EXPECT_EQ(why_no_curve("0:1", 1), "must have at least two points x:y, got \"0:1\"");
  EXPECT_EQ(why_no_curve("0:1 1", 1), "must be points x:y with spaces between, got \"1\"");
  EXPECT_EQ(why_no_curve("0:1 0:2", 1), "must ascend, got 0 after 0");
  EXPECT_EQ(why_no_curve("0:1 1:-2", 1), "must have no values below 0, got -2");
  EXPECT_EQ(why_no_curve("0:a 1:2", 1), "holds \"a\", which is no number");
  EXPECT_EQ(why_no_curve("0:1,2 1:2,3", 3),
            "must be points x:r,g,b with spaces between, got \"0:1,2\"");
}

} // namespace
} // namespace vdbeam
