// Shadow rays of a vertex look for some of many lamps: no bias, and a number that does not vary.
#include "transport/light_draw.h"

#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

constexpr std::size_t drawn_lights = 8;

/// Candidates of different weights, the largest of 60 about 25 times the least; each third is 0.
std::vector<DrawnLight> candidates(std::size_t count) {
  std::vector<DrawnLight> all;
  for (std::size_t i = 0; i < count; ++i) {
    const auto power = static_cast<float>((i * 7) % count);
    all.push_back({i, i % 3 == 2 ? 0 : std::pow(3.0f, power * 0.05f)});
  }
  return all;
}

/// The mean of each candidate's weight, 0 where it is not drawn, is 1, so that sums have no bias.
TEST(LightDraw, KeepsTheSumsMean) {
  constexpr std::size_t count = 60;
  std::vector<Samples> samples(count);
  Rng rng({}, RngStage::walk, 1);
  for (int trial = 0; trial < 20000; ++trial) {
    std::vector<DrawnLight> drawn = candidates(count);
    draw_systematically(drawn, 0, drawn_lights, rng);
    ASSERT_EQ(drawn.size(), drawn_lights);
    std::vector<double> weights(count);
    for (const auto& [light, weight] : drawn)
      weights[light] += static_cast<double>(weight);
    for (std::size_t i = 0; i < count; ++i)
      samples[i].add(weights[i]);
  }
  const std::vector<DrawnLight> all = candidates(count);
  for (std::size_t i = 0; i < count; ++i)
    if (all[i].weight > 0)
      expect_mean(samples[i], 1, 1e-5);
    else
      EXPECT_EQ(samples[i].mean(), 0) << i;
}

/// A lamp beside which the others are faint is always drawn, with the weight 1; the others share
/// the rest of the draws.
TEST(LightDraw, IsCertainOfTheBrightest) {
  Rng rng({}, RngStage::walk, 2);
  for (int trial = 0; trial < 100; ++trial) {
    const float brightest = trial % 2 == 0 ? 1e6f : 1e30f; // beyond double precision, too
    std::vector<DrawnLight> drawn;
    for (std::size_t i = 0; i < 50; ++i)
      drawn.push_back({i, i == 17 ? brightest : 1});
    draw_systematically(drawn, 0, drawn_lights, rng);
    ASSERT_EQ(drawn.size(), drawn_lights);
    for (const auto& [light, weight] : drawn)
      EXPECT_FLOAT_EQ(weight, light == 17 ? 1 : 7) << light;
    EXPECT_TRUE(std::any_of(drawn.begin(), drawn.end(),
                            [](const DrawnLight& one) { return one.light == 17; }));
  }
}

/// What stands before `first` stays, and of a few lamps all are kept, without a random number.
TEST(LightDraw, KeepsAllOfAFew) {
  std::vector<DrawnLight> drawn = candidates(18);
  drawn[0].weight = 5;
  Rng rng({}, RngStage::walk, 3), same = rng;
  draw_systematically(drawn, 1, drawn_lights, rng);
  EXPECT_EQ(drawn.size(), 12U);
  EXPECT_EQ(drawn[0].weight, 5);
  for (std::size_t i = 1; i < drawn.size(); ++i)
    EXPECT_EQ(drawn[i].weight, 1);
  EXPECT_EQ(rng.uniform(), same.uniform());
}

} // namespace
} // namespace vdbeam
