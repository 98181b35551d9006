// Flights find the light of lamps in the medium: against quadrature, and with bounded noise.
#include "support/fog_scene.h"
#include "support/render_passes.h"
#include "support/statistics.h"
#include "support/test_frame.h"

#include "walks/lamp_directions.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

using namespace test;

/// A lamp in the middle of a box of fog, two mean free paths from its faces.
MemoryScene lamp_in_fog() {
  MemoryScene scene;
  VolumeSettings volume = fog(VolumeShape::box, Vec3d(-1), Vec3d(1), 2);
  volume.albedo = Rgb(0.8f);
  volume.phase = henyey_greenstein(0.5);
  add_fog(scene, volume);
  scene.add_light(LightType::point);
  scene.look({0.3, 0.2, 4}, {0, 0, 0}, 40, 12, 12);
  return scene;
}

class LampShellsTest : public ::testing::Test {
protected:
  /// A flight that passes the lamp at this distance, in parts of the distance of its origin.
  Segment flight_past(double offset) const {
    const Vec3d from = lamp_ + Vec3d(-0.1, 0, 0) * world().space.scale;
    const Vec3f direction(normalize(Vec3d(1, offset, 0)));
    std::optional<SurfaceHit> end;
    return world().medium.clip(flight_segment(world(), from, direction, end));
  }
  /// Light that the flight's collisions within the shell scatter against it, by the midpoint rule.
  double by_quadrature(const Segment& flight) const {
    const Volume& volume = world().medium.volumes.front();
    const Light& light = world().lights[0];
    constexpr int steps = 1 << 20;
    const double step = static_cast<double>(flight.t_end) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) * step;
      const Vec3d point = Vec3d(flight.ray.origin) + Vec3d(flight.ray.direction) * t;
      if (!shells_.holds(0, Vec3f(point)))
        continue;
      const double distance = length(lamp_ - point);
      const Vec3f wi((lamp_ - point) / distance);
      const auto p =
          static_cast<double>(world().medium.phases[0].evaluate(dot(flight.ray.direction, wi)));
      const auto sigma = static_cast<double>(volume.extinction);
      const auto irradiance =
          static_cast<double>(light.sample_incident(Vec3f(point), 0.5f, 0.5f).value.x);
      sum += step * static_cast<double>(volume.albedo.x) * sigma * p * irradiance *
             std::exp(-sigma * (t + distance));
    }
    return sum;
  }
  Samples by_sampling(const Segment& flight) const {
    Samples samples;
    Rng rng({}, RngStage::walk, 1);
    std::uint64_t shadow_rays = 0;
    for (int i = 0; i < 20000; ++i)
      samples.add(static_cast<double>(shells_.along(flight, rng, shadow_rays).sum().x));
    return samples;
  }
  const World& world() const { return frame_.world; }

  TestFrame frame_{lamp_in_fog()};
  LampShells shells_{frame_.world, {true}};
  Vec3d lamp_ = *frame_.world.lights[0].position();
};

TEST_F(LampShellsTest, AgreeWithQuadrature) {
  for (const double offset : {0.9, 0.1, 0.01}) {
    const Segment flight = flight_past(offset);
    const Samples samples = by_sampling(flight);
    const double expected = by_quadrature(flight);
    expect_power(samples, 0.01 * expected);
    expect_mean(samples, expected, 1e-4 * expected);
  }
}

/// The density of the samples cancels 1 / r^2, however near the flight passes. The variance of
/// points where flights collide would grow as the inverse of the distance. The phase function
/// alone, which is 27 times as high forwards as backwards, has nearly the square of its mean.
TEST_F(LampShellsTest, AreAsQuietNearTheLamp) {
  for (const double offset : {0.1, 1e-3, 1e-5}) {
    const Samples samples = by_sampling(flight_past(offset));
    EXPECT_LT(samples.variance(), 4 * samples.mean() * samples.mean()) << offset;
  }
}

/// A lamp beyond the medium, or one that shadow rays do not look for, has no shell.
TEST_F(LampShellsTest, AreAroundLampsInTheMediumOnly) {
  EXPECT_TRUE(shells_.any());
  EXPECT_FALSE(LampShells(world(), {false}).any());
  MemoryScene scene = lamp_in_fog();
  scene.scene.lights[0].position = {0, 0, 5};
  const TestFrame far(scene);
  EXPECT_FALSE(LampShells(far.world, {true}).any());
}

/// Directions about a lamp have the density that is stated, close to the lamp too; beyond reach
/// there are none.
TEST_F(LampShellsTest, DrawDirectionsAboutLampsByTheirDensity) {
  const LampDirections directions(world(), shells_);
  const LampDirections::Vertex near_vertex =
      directions.at(Vec3f(lamp_ + Vec3d(0.5, 0, 0) * shells_.radius_of(0)));
  Rng rng({}, RngStage::walk, 2);
  for (const double angle : {0.03, 1.0}) {
    Samples cone, drawn; // the solid angle of a cone about the lamp, and how many are drawn
    for (int i = 0; i < 400000; ++i) {
      const std::optional<Vec3f> direction = near_vertex.sample(rng);
      const bool inside = direction && -direction->x > std::cos(angle);
      cone.add(inside ? 1 / static_cast<double>(near_vertex.density(*direction)) : 0);
      drawn.add(direction ? 1 : 0);
    }
    expect_mean(cone, 2 * std::numbers::pi * (1 - std::cos(angle)));
    expect_mean(drawn, static_cast<double>(near_vertex.chance()));
  }
  const LampDirections::Vertex far_vertex =
      directions.at(Vec3f(lamp_ + Vec3d(2, 0, 0) * LampDirections::reach(shells_, 0)));
  EXPECT_FALSE(far_vertex.sample(rng));
  EXPECT_EQ(far_vertex.density({-1, 0, 0}), 0);
  EXPECT_EQ(far_vertex.chance(), 0);
}

/// Where a path may scatter twice at most, its flights look for lamps only before the second event.
TEST(LampShellsOfPath, KeepTheLimitOfBounces) {
  for (const int limit : {1, 2, 3}) {
    MemoryScene scene = lamp_in_fog();
    scene.scene.render.max_bounces = limit;
    const PassMeans path = render_passes(scene, EstimatorType::path, 192);
    const PassMeans march = render_passes(scene, EstimatorType::march, 48);
    SCOPED_TRACE(limit);
    expect_same_mean(path.indirect[0], march.indirect[0], 0.02 * march.indirect[0].mean());
    expect_power(path.indirect[0], 0.02 * march.total[0].mean());
  }
}

/// Walks that gather photons find the light of lamps by the same means as paths do: both have the
/// same mean, and little noise.
TEST(LampShellsOfGather, HaveTheLightOfPaths) {
  const MemoryScene scene = lamp_in_fog();
  const PassMeans path = render_passes(scene, EstimatorType::path, 200);
  const PassMeans gather = render_passes(scene, EstimatorType::gather, 200);
  expect_same_mean(path.indirect[0], gather.indirect[0], 0.04 * path.indirect[0].mean());
  EXPECT_LT(gather.indirect[0].error(), 0.01 * gather.indirect[0].mean()); // 0.021 by shadow rays
}

} // namespace
} // namespace vdbeam
