// Direct light at a vertex of a path: one function for all.
#include "transport/next_event.h"

#include "support/fog_scene.h"
#include "support/statistics.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

using namespace test;

/// Scatters even + slope cos(theta), which is negative backwards, as truncated phase functions are.
struct LinearVertex {
  Vec3f point{0.1f, 0, 0};
  float even = 0.05f, slope = 0.2f;

  const Vec3f& position() const { return point; }
  Vec3d leave(const Vec3f&) const { return Vec3d(point); }
  Rgb evaluate(const Vec3f& wi) const { return Rgb(even + slope * wi.x); }
};

MemoryScene scene_under_sky() {
  MemoryScene scene;
  add_fog(scene, fog(VolumeShape::box, Vec3d(-1), Vec3d(1), 1));
  scene.add_light(LightType::environment).radiance = {1, 2, 3};
  scene.look({0, 0, 4}, {0, 0, 0}, 40, 4, 4);
  return scene;
}

class NextEvent : public ::testing::Test {
protected:
  template <class Pdf>
  Samples sample(const Pdf& pdf) {
    Samples samples;
    for (int i = 0; i < 20000; ++i) {
      const auto ray =
          sample_direct_light(frame_.world, frame_.world.lights[0], vertex_, rng_, pdf);
      samples.add(ray ? static_cast<double>(ray->radiance().y) : 0);
    }
    return samples;
  }

  TestFrame frame_{scene_under_sky()};
  LinearVertex vertex_;
  Rng rng_{{}, RngStage::walk, 1};
  /// The integral of the vertex's factor over the sphere, times the sky's radiance.
  double expected_ = 2 * 0.05 * 4 * std::numbers::pi;
};

TEST_F(NextEvent, CountsNegativeValues) {
  const Samples samples = sample([](const Vec3f&) { return 0.0f; });
  expect_power(samples, 0.05 * expected_);
  expect_mean(samples, expected_, 1e-4 * expected_);
}

/// The balance heuristic leaves to the path's own directions the share that it does not take: with
/// the density of the light's samples, half.
TEST_F(NextEvent, SharesWithTheDirectionsOfThePath) {
  const Light& sky = frame_.world.lights[0];
  const Samples samples =
      sample([&](const Vec3f& wi) { return sky.incident_pdf(vertex_.point, wi); });
  expect_power(samples, 0.05 * expected_);
  expect_mean(samples, 0.5 * expected_, 1e-4 * expected_);
}

TEST_F(NextEvent, GivesTheWayOfTheShadowRay) {
  const Vec3f towards(0, 0, 1);
  const PhaseFunction& phase = frame_.world.medium.phases[0];
  const MediumVertex vertex{vertex_.point, towards, phase};
  const auto ray = sample_direct_light(frame_.world, frame_.world.lights[0], vertex, rng_);
  ASSERT_TRUE(ray);
  EXPECT_EQ(ray->segment.ray.origin, vertex_.point);
  EXPECT_EQ(ray->segment.t_end, infinity);
  EXPECT_EQ(ray->scattered, Rgb(phase.evaluate(dot(towards, ray->direction()))));
  EXPECT_EQ(ray->weight, 1);
}

} // namespace
} // namespace vdbeam
