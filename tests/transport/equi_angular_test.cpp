#include "medium/equi_angular.h"

#include "math/rng.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

struct Case {
  Ray ray;
  Vec3d light;
  float begin, end;
};

const Case cases[] = {
    {{{0, 0, 0}, {1, 0, 0}}, {0.5, 0.1, 0.2}, 0, 2},      // beside the piece
    {{{0, 0, 0}, {1, 0, 0}}, {0.5, 1e-3, 0}, 0.2f, 2},    // nearly on it
    {{{0, 0, 0}, {0, 1, 0}}, {0.3, -1, 0.2}, 0.5f, 1.5f}, // behind its start
    {{{0, 0, 0}, {0, 0, 1}}, {50, 20, 80}, 0, 1},         // far away
};

/// With equal angles, or with `angles`.
void expect_samples_follow_the_density(const ScatteringAngles* angles) {
  for (const Case& c : cases) {
    const EquiAngular distances(c.ray, c.light, c.begin, c.end, angles);
    constexpr int bins = 40, count = 100000;
    std::vector<double> counts(bins), expected(bins);
    double total = 0;
    for (int b = 0; b < bins; ++b) {
      constexpr int steps = 2000;
      const double width = static_cast<double>(c.end - c.begin) / bins;
      for (int i = 0; i < steps; ++i) {
        const double t = static_cast<double>(c.begin) + (b + (i + 0.5) / steps) * width;
        expected[static_cast<std::size_t>(b)] +=
            static_cast<double>(distances.pdf(static_cast<float>(t))) * width / steps * count;
      }
      total += expected[static_cast<std::size_t>(b)];
    }
    EXPECT_NEAR(total, count, 1e-3 * count); // the density integrates to 1
    Rng rng({1, 0, 0}, RngStage::test, 1);
    for (int n = 0; n < count; ++n) {
      const float t = distances.sample(rng.uniform());
      ASSERT_GE(t, c.begin);
      ASSERT_LE(t, c.end);
      const double place = static_cast<double>((t - c.begin) / (c.end - c.begin)) * bins;
      ++counts[static_cast<std::size_t>(std::min(place, bins - 0.5))];
    }
    EXPECT_GT(test::chi_squared_test(counts, expected), test::family_level(8));
  }
}

TEST(EquiAngular, SamplesFollowTheDensity) {
  expect_samples_follow_the_density(nullptr);
}

TEST(EquiAngular, SamplesFollowTheDensityOfScatteringAngles) {
  PhaseSettings settings;
  settings.type = PhaseType::henyey_greenstein;
  settings.g = 0.9f;
  const ScatteringAngles angles({PhaseFunction(settings)});
  expect_samples_follow_the_density(&angles);
}

TEST(EquiAngular, IsUsedForLightsNearby) {
  const Ray ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_TRUE(EquiAngular(ray, {1, 0.6, 0}, 0, 2).useful());
  EXPECT_FALSE(EquiAngular(ray, {1, 1.2, 0}, 0, 2).useful());
  EXPECT_FALSE(EquiAngular(ray, {3, 0, 0}, 0, 2).useful());
}

TEST(EquiAngular, RayThroughTheLightIsFinite) {
  const EquiAngular distances({{0, 0, 0}, {1, 0, 0}}, {1, 0, 0}, 0, 2);
  for (const float u : {0.0f, 0.3f, 0.5f, 1.0f}) {
    const float t = distances.sample(u);
    EXPECT_TRUE(std::isfinite(t) && std::isfinite(distances.pdf(t)));
  }
}

} // namespace
} // namespace vdbeam
