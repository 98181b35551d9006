// A vertex that draws a few of many lamps finds the light of all of them.
#include "support/render_passes.h"
#include "support/surface_test.h"
#include "transport/light_draw.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

using namespace test::surfaces;

constexpr int all_lamps = 48, parts = 3, passes = 48;

/// Fog over a ground with the lamps of one part: points and spots in and about the fog, and balls
/// that shine above it, all beside the view, of very different brightness. Part -1: all of them.
MemoryScene lamps_in_fog(int part) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box({-1.6, -1, -1}, {1.6, 1, 1});
  box.extinction = 0.8;
  box.albedo = Rgb(0.9f);
  box.phase = henyey_greenstein(0.6);
  scene.look({0, 0.6, 4}, {0, -0.2, 0}, 22, 12, 12);
  add_surface(scene, SurfaceShape::quad, {3, 0, 0, 0, 0, 0, 3, -1.05, 0, -3, 0, 0}, diffuse(0.5));
  for (int i = 0; i < all_lamps; ++i) {
    if (part >= 0 && i % parts != part)
      continue;
    const double side = i % 2 == 0 ? 1 : -1, depth = std::fmod(0.618 * i, 1);
    const Vec3d position{side * (1.05 + 0.02 * i), 0.04 * i - 0.9, 2 * depth - 1};
    const float strength = std::pow(2.0f, static_cast<float>((i * 5) % 7)) / 200;
    if (i % 4 == 3) {
      constexpr double radius = 0.03;
      add_surface(scene, SurfaceShape::sphere, moved(scaled(radius), {position.x, 1.9, position.z}),
                  shining(strength / (pi * static_cast<float>(radius * radius))));
      continue;
    }
    LightSettings& light = scene.add_light(i % 4 == 0 ? LightType::spot : LightType::point);
    light.position = position;
    light.intensity = Rgb(strength);
    light.direction = {0.1, -1, 0.2};
    light.cone_angle = 50;
  }
  return scene;
}

class ManyLamps : public ::testing::TestWithParam<EstimatorType> {};

/// The sum of a mean over the parts, and the variance of that sum.
struct SumOfParts {
  double mean = 0, variance = 0;

  void add(const Samples& samples) {
    mean += samples.mean();
    variance += std::pow(samples.error(), 2);
  }
};

/// Allows five standard errors, which chance exceeds in less than one of 1000 runs of these tests,
/// and what the balls of other parts may hide. The errors must be less than `power` of the value.
void expect_sum(const Samples& all, const SumOfParts& parts_sum, double power) {
  constexpr double limit = 5, hidden = 2e-3;
  const double error = limit * std::sqrt(parts_sum.variance + std::pow(all.error(), 2));
  EXPECT_LT(error, power * parts_sum.mean);
  EXPECT_NEAR(all.mean(), parts_sum.mean, error + hidden * parts_sum.mean);
}

/// One image of 48 lamps, drawn, is the sum of three of 16, which are looked for one and all.
TEST_P(ManyLamps, BringTheSumOfTheirLight) {
  // A pass of `path` is short where each vertex has many shadow rays, and has more noise.
  const int count = GetParam() == EstimatorType::path ? 3 * passes : passes;
  const PassMeans all = render_passes(lamps_in_fog(-1), GetParam(), count);
  SumOfParts total;
  std::array<SumOfParts, region_rows * region_rows> regions;
  std::uint64_t shadow_rays = 0;
  for (int part = 0; part < parts; ++part) {
    const PassMeans one = render_passes(lamps_in_fog(part), GetParam(), count);
    total.add(one.total[1]);
    for (std::size_t region = 0; region < regions.size(); ++region)
      regions[region].add(one.regions[region]);
    shadow_rays += one.statistics.shadow_rays;
  }
  EXPECT_LT(all.statistics.shadow_rays, shadow_rays / 2);
  expect_sum(all.total[1], total, 0.08);
  for (std::size_t region = 0; region < regions.size(); ++region)
    expect_sum(all.regions[region], regions[region], 0.2);
}

/// Shadow rays of a walk of `path` in fog, the mean over walks.
double shadow_rays_per_walk(int lamps) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box({-1, -1, -1}, {1, 1, 1});
  box.extinction = 2;
  scene.look({0, 0, 4}, {0, 0, 0}, 22, 12, 12);
  for (int i = 0; i < lamps; ++i)
    scene.add_light(LightType::point).position = {3 + 0.1 * i, 2, 1};
  const RenderStatistics counts = render_passes(scene, EstimatorType::path, passes).statistics;
  return static_cast<double>(counts.walk_shadow_rays) / static_cast<double>(counts.camera_walks);
}

/// The pilot of `path` and the forecast of `auto` count what lamps cost: each vertex of a walk
/// looks for all of 12 lamps, but for 8 of 48.
TEST(ShadowRaysOfWalks, AreCounted) {
  const double one = shadow_rays_per_walk(1);
  EXPECT_GT(one, 0.5);
  EXPECT_NEAR(shadow_rays_per_walk(12), 12 * one, 0.05 * 12 * one);
  EXPECT_NEAR(shadow_rays_per_walk(48), 8 * one, 0.05 * 8 * one);
}

INSTANTIATE_TEST_SUITE_P(All, ManyLamps,
                         ::testing::Values(EstimatorType::beam, EstimatorType::gather,
                                           EstimatorType::march, EstimatorType::path),
                         [](const auto& type) { return std::string(type.param.name); });

} // namespace
} // namespace vdbeam
