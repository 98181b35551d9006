// How `path` divides its time among the parts of a camera ray's light.
#include "estimators/path/path_effort.h"

#include "math/rng.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

PathTrial trial() {
  PathTrial trial;
  trial.parts = {{{8, 300}, {24, 2000}, {8, 1000}}};
  trial.ray_variance = 2;
  trial.ray_time = 1000;
  return trial;
}

/// Variance times time, which the effort is to make small.
double product(const PathTrial& trial, const PathEffort& effort) {
  double variance = trial.ray_variance, time = trial.ray_time;
  for (std::size_t i = 0; i < path_part_count; ++i) {
    variance += trial.parts[i].variance / static_cast<double>(effort.draws[i]);
    time += trial.parts[i].time * static_cast<double>(effort.draws[i]);
  }
  return variance * time;
}

TEST(PathEffort, NoOtherDrawsDoBetter) {
  const PathTrial measured = trial();
  const PathEffort best = measured.best_effort();
  for (std::size_t i = 0; i < path_part_count; ++i)
    for (const float factor : {0.8f, 1.25f}) {
      PathEffort other = best;
      other.draws[i] *= factor;
      EXPECT_GT(product(measured, other), product(measured, best)) << i << " " << factor;
    }
}

/// Rare, bright paths may have escaped the pilot.
TEST(PathEffort, EachPartTakesTheTimeOfTheRay) {
  PathTrial measured = trial();
  measured.ray_time = 8000;
  for (PathTrial::Part& part : measured.parts)
    part.variance = 0;
  const PathEffort effort = measured.best_effort();
  EXPECT_FLOAT_EQ(effort.draws[0], 8000.0f / 300);
  EXPECT_FLOAT_EQ(effort.draws[1], 4);
  EXPECT_FLOAT_EQ(effort.draws[2], 8);
}

TEST(PathEffort, StaysWithinItsLimits) {
  PathTrial measured = trial();
  measured.parts[0] = {};          // nothing scatters
  measured.parts[1].time = 1e12;   // endless walks
  measured.parts[2].variance = 50; // dark surfaces with bright spots
  measured.parts[2].time = 1;
  measured.ray_variance = -1; // as products of noise may be
  const PathEffort effort = measured.best_effort();
  EXPECT_EQ(effort.draws[0], 1);
  EXPECT_EQ(effort.draws[1], 1);
  EXPECT_EQ(effort.draws[2], PathEffort::most);
  for (const float draws : PathTrial().best_effort().draws)
    EXPECT_EQ(draws, 1);
}

TEST(PathEffort, DrawsHaveTheRightMean) {
  PathEffort effort;
  effort.of(PathPart::walks) = 6;
  Rng rng({}, RngStage::test, 1);
  for (const float share : {1.0f, 0.4f, 0.1f, 5e-7f, 5e-8f}) {
    test::Samples whole, count;
    for (int i = 0; i < 200000; ++i) {
      const PartDraws draws = effort.draws_of(PathPart::walks, share, rng.uniform());
      whole.add(static_cast<double>(static_cast<float>(draws.count) * draws.weight));
      count.add(draws.count);
    }
    test::expect_mean(whole, 1);
    if (share > 1e-6f) {
      EXPECT_NEAR(count.mean(), std::max(1.0, 6 * static_cast<double>(share)), 0.5);
    }
    EXPECT_LT(whole.error(), 0.03);
  }
  EXPECT_EQ(effort.draws_of(PathPart::walks, 0, 0).count, 0);
}

} // namespace
} // namespace vdbeam
