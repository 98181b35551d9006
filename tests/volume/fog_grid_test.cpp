// Volumes without a file against their formulas.
#include "grids/fog_grid.h"

#include "math/rng.h"
#include "math/sampling.h"
#include "medium/optical_depth.h"
#include "support/fog_scene.h"
#include "vdbeam/error.h"
#include "volume/fog_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace vdbeam {
namespace {

using namespace test;

/// A world of one volume, asked in world units.
struct FogWorld {
  explicit FogWorld(const VolumeSettings& volume) {
    add_fog(scene, volume);
    world = scene.world();
  }

  const Volume& volume() const { return world.medium.volumes[0]; }
  /// Between two points, in double precision where the pieces are added.
  double optical_depth(const Vec3d& from, const Vec3d& to) const {
    const Vec3d a = world.space.point(from), b = world.space.point(to);
    const double distance = length(b - a);
    double sum = 0;
    for_each_piece(volume(),
                   {{Vec3f(a), Vec3f((b - a) / distance)}, 0, static_cast<float>(distance)},
                   [&](float, float, float piece) {
                     sum += static_cast<double>(piece);
                     return true;
                   });
    return sum;
  }
  double density(const Vec3d& at) const {
    return static_cast<double>(volume().density(Vec3f(world.space.point(at))));
  }

  MemoryScene scene;
  World world;
};

Vec3d random_point(Rng& rng, const Vec3d& lower, const Vec3d& upper) {
  const double x = rng.uniform(), y = rng.uniform();
  return lower + (upper - lower) * Vec3d(x, y, static_cast<double>(rng.uniform()));
}

/// Length of the part of a line, from 0 to 1 between two points, inside a box.
double length_inside(const Vec3d& from, const Vec3d& to, const Vec3d& lower, const Vec3d& upper) {
  double enter = 0, leave = 1;
  for (int a = 0; a < 3; ++a) {
    const double t0 = (lower[a] - from[a]) / (to[a] - from[a]),
                 t1 = (upper[a] - from[a]) / (to[a] - from[a]);
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return std::max(0.0, leave - enter) * length(to - from);
}

TEST(FogBox, OpticalDepthIsTheLengthInside) {
  const Vec3d lower{-3, 1, 2}, upper{5, 2, 9};
  const FogWorld fog_world(fog(VolumeShape::box, lower, upper, 0.7));
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Rng rng({}, RngStage::test, i);
    const Vec3d from = random_point(rng, lower - Vec3d(4), upper + Vec3d(4));
    const Vec3d to = random_point(rng, lower - Vec3d(4), upper + Vec3d(4));
    EXPECT_NEAR(fog_world.optical_depth(from, to), 0.7 * length_inside(from, to, lower, upper),
                1e-5);
  }
}

TEST(FogBox, FacesAreSharp) {
  const FogWorld fog_world(fog(VolumeShape::box, {-3, 1, 2}, {5, 2, 9}));
  constexpr double little = 1e-5;
  for (const double side : {-little, little}) {
    const double inside = side > 0 ? 1 : 0;
    EXPECT_EQ(fog_world.density({-3 + side, 1.5, 4}), inside);
    EXPECT_EQ(fog_world.density({5 - side, 1.5, 4}), inside);
    EXPECT_EQ(fog_world.density({1, 1 + side, 4}), inside);
    EXPECT_EQ(fog_world.density({1, 2 - side, 4}), inside);
    EXPECT_EQ(fog_world.density({1, 1.5, 9 - side}), inside);
  }
  EXPECT_EQ(fog_world.volume().field.brick_count(), 0);
}

TEST(FogBox, TransformPlacesIt) {
  VolumeSettings volume = fog(VolumeShape::box, Vec3d(-1), Vec3d(1));
  const double s = std::sqrt(0.5); // 45 degrees about z, twice as large, moved
  volume.transform = {2 * s, -2 * s, 0, 10, 2 * s, 2 * s, 0, 20, 0, 0, 2, 30};
  const FogWorld fog_world(volume);
  EXPECT_NEAR(fog_world.optical_depth({0, 20, 30}, {20, 20, 30}), 4 * std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(fog_world.optical_depth({10, 20, 0}, {10, 20, 60}), 4, 1e-5);
}

/// Integral of exp(-(y - bottom) / height) along a line between two points of the box.
double through_heights(const Vec3d& from, const Vec3d& to, double bottom, double height) {
  const double a = (from.y - bottom) / height, b = (to.y - bottom) / height;
  const double mean =
      std::abs(b - a) < 1e-9 ? std::exp(-a) : (std::exp(-a) - std::exp(-b)) / (b - a);
  return mean * length(to - from);
}

TEST(FogHeight, OpticalDepthAgainstTheFormula) {
  const Vec3d lower{-20, 3, -30}, upper{20, 100, 10};
  VolumeSettings volume = fog(VolumeShape::height, lower, upper, 0.3);
  volume.fog.scale_height = 4;
  const FogWorld fog_world(volume);
  const double top = 3 + 4 * std::log(1000.0);
  EXPECT_EQ(fog_world.density({0, top + 1e-4, 0}), 0);
  EXPECT_NEAR(fog_world.density({0, top - 1e-4, 0}), 1e-3, 1e-6);
  EXPECT_EQ(fog_world.density({0, 3 - 1e-4, 0}), 0);
  EXPECT_EQ(fog_world.density({20 + 1e-4, 5, 0}), 0);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    Rng rng({}, RngStage::test, i);
    // From bottom to top, through whole planes.
    const Vec3d from = random_point(rng, {-20, 3, -30}, {20, 3, 10});
    const Vec3d to = random_point(rng, {-20, top, -30}, {20, top, 10});
    const double whole = 0.3 * through_heights(from, to, 3, 4);
    EXPECT_NEAR(fog_world.optical_depth(from, to), whole, 1e-5 * whole);
    // Anywhere: the density between planes is off by 8e-5 at most.
    const Vec3d a = random_point(rng, {-20, 3, -30}, {20, top, 10});
    const Vec3d b = random_point(rng, {-20, 3, -30}, {20, top, 10});
    const double part = 0.3 * through_heights(a, b, 3, 4);
    EXPECT_NEAR(fog_world.optical_depth(a, b), part, 1e-4 * part + 1e-6);
    const double density = std::exp(-(a.y - 3) / 4);
    EXPECT_NEAR(fog_world.density(a), density, 1e-4 * density);
  }
}

TEST(FogHeight, LayersShareTheirBricks) {
  VolumeSettings volume = fog(VolumeShape::height, {-500, 0, -500}, {500, 100, 500});
  volume.fog.scale_height = 10;
  const DensityGrid grid = fog_grid(volume, std::uint64_t(1) << 30);
  EXPECT_EQ(grid.field.brick_count(), static_cast<std::size_t>(grid.field.cell_counts().y));
  EXPECT_LT(grid.field.bytes(), 1u << 20);
  EXPECT_EQ(fog_bytes(volume), grid.field.bytes() - sizeof(float)); // the uniform value
}

TEST(FogHeight, WithoutAFallItIsABox) {
  VolumeSettings volume = fog(VolumeShape::height, Vec3d(-1), Vec3d(1));
  volume.fog.scale_height = 1e9;
  const FogWorld fog_world(volume);
  EXPECT_NEAR(fog_world.optical_depth({0.1, -3, 0.2}, {0.1, 3, 0.2}), 2, 1e-5);
  EXPECT_NEAR(fog_world.optical_depth({-3, 0.3, 0.2}, {3, 0.3, 0.2}), 2, 1e-5);
}

/// The surface rises over a voxel, a 254th of the diameter: chords are off by little, and by less
/// in the mean.
TEST(FogSphere, OpticalDepthIsTheChord) {
  const FogWorld fog_world(fog(VolumeShape::sphere, {-1, 2, -3}, {3, 6, 1}, 1.5)); // radius 2
  const Vec3d center{1, 4, -1};
  double sum = 0, expected_sum = 0, worst = 0, worst_grazing = 0;
  for (std::uint64_t i = 0; i < 4000; ++i) {
    Rng rng({}, RngStage::test, i);
    const double z = 2 * rng.uniform() - 1, phi = 2 * std::numbers::pi * rng.uniform();
    const double r = std::sqrt(1 - z * z);
    const Vec3d along{r * std::cos(phi), r * std::sin(phi), z};
    Vec3d side, other;
    orthonormal_frame(along, side, other);
    const double b = 2 * std::sqrt(static_cast<double>(rng.uniform()));
    const Vec3d middle = center + side * b;
    const double found = fog_world.optical_depth(middle - along * 5.0, middle + along * 5.0);
    const double expected = 1.5 * 2 * std::sqrt(std::max(0.0, 4 - b * b));
    double& most = b < 1.6 ? worst : worst_grazing;
    if (b < 1.9)
      most = std::max(most, std::abs(found - expected));
    sum += found;
    expected_sum += expected;
  }
  EXPECT_LT(worst, 1e-3 * 6); // of the depth along the diameter
  EXPECT_LT(worst_grazing, 2.5e-3 * 6);
  RecordProperty("worst", std::to_string(worst / 6));
  EXPECT_NEAR(sum, expected_sum, 3e-4 * expected_sum);
  EXPECT_NEAR(fog_world.density(center), 1, 0);
  EXPECT_EQ(fog_world.density(center + Vec3d(0, 2.02, 0)), 0);
  EXPECT_EQ(fog_world.density(center + Vec3d(0, 1.98, 0)), 1);
}

TEST(FogSphere, FillsABoxAsAnEllipsoid) {
  const FogWorld fog_world(fog(VolumeShape::sphere, {-1, -10, -2}, {1, 10, 2}));
  EXPECT_NEAR(fog_world.optical_depth({0, -20, 0}, {0, 20, 0}), 20, 0.02);
  EXPECT_NEAR(fog_world.optical_depth({-5, 0, 0}, {5, 0, 0}), 2, 0.002);
  EXPECT_NEAR(fog_world.optical_depth({-5, 8, 0}, {5, 8, 0}), 2 * 0.6, 0.005);
}

/// A fog of 20,000 units around the eye: what lies a few units before it is found as exactly.
TEST(Fog, OfTwentyThousandUnitsAroundTheCamera) {
  const FogWorld box(fog(VolumeShape::box, Vec3d(-10000), Vec3d(10000), 1e-3));
  const Vec3d eye{17, -2, 5};
  for (const double distance : {1.0, 100.0, 5000.0})
    EXPECT_NEAR(box.optical_depth(eye, eye + Vec3d(0.6, 0, 0.8) * distance), 1e-3 * distance,
                1e-6 * distance + 1e-6);
  EXPECT_NEAR(box.optical_depth(eye, {17, -2, 1e6}), 1e-3 * 9995, 1e-5 * 10);
}

TEST(Fog, FromHardlyAnyToAWall) {
  const FogWorld thin(fog(VolumeShape::box, Vec3d(-1), Vec3d(1), 1e-9));
  EXPECT_NEAR(thin.optical_depth({0, 0, -3}, {0, 0, 3}), 2e-9, 1e-14);
  const FogWorld dense(fog(VolumeShape::box, Vec3d(-1), Vec3d(1), 1e6));
  EXPECT_NEAR(dense.optical_depth({0, 0, -3}, {0, 0, 3}), 2e6, 20);
  EXPECT_EQ(exact_transmittance(dense.world.medium, {{{-3, 0, 0}, {1, 0, 0}}}), Rgb(0));
}

class NoisyFog : public ::testing::TestWithParam<VolumeShape> {};

/// Noise moves what is there: nothing comes to be farther off, the amount of it hardly changes, and
/// no density is above its majorant.
TEST_P(NoisyFog, IsDisplaced) {
  VolumeSettings volume = fog(GetParam(), Vec3d(-4), Vec3d(4));
  volume.fog.scale_height = 2;
  const FogWorld plain(volume);
  volume.noise.amplitude = 0.5;
  volume.noise.size = 2;
  const FogWorld noisy(volume);
  const Boxf& occupied = noisy.volume().field.occupied();
  const Boxd world =
      FogShape(volume).to_own().bounds({Vec3d(occupied.lower), Vec3d(occupied.upper)});
  double before = 0, after = 0, changed = 0;
  constexpr int count = 20000;
  for (std::uint64_t i = 0; i < count; ++i) {
    Rng rng({}, RngStage::test, i);
    const Vec3d at = random_point(rng, Vec3d(-5), Vec3d(5));
    const Vec3f local = Vec3f(noisy.world.space.point(at));
    const double density = noisy.density(at);
    EXPECT_LE(density * 0.999999, noisy.volume().majorant(local) / noisy.volume().extinction);
    before += plain.density(at);
    after += density;
    changed += std::abs(density - plain.density(at));
  }
  EXPECT_NEAR(after, before, 0.06 * before);
  EXPECT_GT(changed, 0.02 * before);
  for (int a = 0; a < 3; ++a) {
    EXPECT_GT(world.lower[a], -4.8);
    EXPECT_LT(world.upper[a], 4.8);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, NoisyFog,
                         ::testing::Values(VolumeShape::box, VolumeShape::sphere,
                                           VolumeShape::height));

TEST(NoisyFogLattice, IsTooCoarseForVeryFineNoise) {
  VolumeSettings volume = fog(VolumeShape::box, Vec3d(-100), Vec3d(100));
  volume.noise.amplitude = 0.1;
  volume.noise.size = 20;
  EXPECT_FALSE(FogShape(volume).is_coarse());
  volume.noise.size = 0.5;
  EXPECT_TRUE(FogShape(volume).is_coarse());
  EXPECT_THROW(fog_grid(volume, std::uint64_t(1) << 20), FrameError);
}

} // namespace
} // namespace vdbeam
