#include "medium/scattering.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr int walks = 4000;
constexpr std::uint64_t longest = 40000;

/// Mean weight that is under way after `collisions` collisions, over walks that nothing else ends.
test::Samples weight_after(std::uint64_t collisions) {
  test::Samples samples;
  for (std::uint64_t n = 0; n < walks; ++n) {
    Rng rng({1, 0, 0}, RngStage::test, n);
    LengthRoulette roulette;
    Rgb weight(1);
    bool alive = true;
    for (std::uint64_t i = 0; alive && i < collisions; ++i)
      alive = roulette.survive(weight, rng);
    samples.add(alive ? static_cast<double>(weight.x) : 0);
  }
  return samples;
}

TEST(LengthRoulette, LeavesShortPathsAlone) {
  const test::Samples samples = weight_after(4095);
  EXPECT_EQ(samples.mean(), 1);
  EXPECT_EQ(samples.variance(), 0);
}

/// Survivors stand for those that end: the mean weight stays 1, however long the path. After
/// 40,000 collisions four decisions have been taken, so the variance is 3.
TEST(LengthRoulette, KeepsTheMeanWeight) {
  for (const std::uint64_t collisions : {std::uint64_t{4096}, std::uint64_t{9000}, longest})
    test::expect_mean(weight_after(collisions), 1);
}

/// It does end paths: a share 1 / sqrt(2) is left whenever the length has doubled.
TEST(LengthRoulette, BoundsTheWork) {
  std::uint64_t left = 0;
  for (std::uint64_t n = 0; n < walks; ++n) {
    Rng rng({2, 0, 0}, RngStage::test, n);
    LengthRoulette roulette;
    Rgb weight(1);
    std::uint64_t i = 0;
    while (i < longest && roulette.survive(weight, rng))
      ++i;
    left += i == longest;
  }
  const double share = static_cast<double>(left) / walks;
  EXPECT_NEAR(share, 0.25, 4 * std::sqrt(0.25 * 0.75 / walks));
}

} // namespace
} // namespace vdbeam
