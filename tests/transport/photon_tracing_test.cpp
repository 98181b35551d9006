#include "transport/photon_tracing.h"

#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace vdbeam {
namespace {

using test::MemoryScene;
using test::Samples;

/// A unit cube about the origin, homogeneous.
MemoryScene cube(double extinction, const Rgb& albedo) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
  volume.extinction = extinction;
  volume.albedo = albedo;
  return scene;
}

PhotonPassSettings settings(std::uint64_t paths, std::uint64_t pass) {
  PhotonPassSettings result;
  result.paths = paths;
  result.skip_first_flight = {false};
  result.key = {1, 1, pass};
  return result;
}

/// Per pass: the sum over photons of power times what `weigh` gives.
template <class Weigh>
std::array<Samples, 3> power_sums(const World& world, PhotonPassSettings pass_settings, int passes,
                                  const Weigh& weigh) {
  std::array<Samples, 3> samples;
  for (int pass = 0; pass < passes; ++pass) {
    pass_settings.key.pass = static_cast<std::uint64_t>(pass);
    const PhotonList photons = trace_photons(world, pass_settings).photons;
    Vec3d sum;
    for (std::size_t i = 0; i < photons.size(); ++i)
      sum += Vec3d(photons.power[i]) * static_cast<double>(weigh(photons.position[i]));
    for (int c = 0; c < 3; ++c)
      samples[static_cast<std::size_t>(c)].add(sum[c]);
  }
  return samples;
}

/// sigma_t of all volumes' strongest channels at a point.
float sigma_at(const World& world, const Vec3f& point) {
  float sum = 0;
  for (const Volume& volume : world.medium.volumes)
    sum += volume.extinction * volume.density(point);
  return sum;
}

LightSettings sun() {
  LightSettings light;
  light.type = LightType::distant;
  light.direction = {0, 0, -1};
  return light;
}

// Light 1 W/m^2 falls on one face of 1 m^2. Without scattering the collision rate, fluence times
// sigma_t, is what Beer and Lambert leave behind.
TEST(PhotonTracing, FluenceOfALoneAbsorberIsBeerLambert) {
  MemoryScene scene = cube(3, Rgb(0));
  scene.scene.lights.push_back(sun());
  const World world = scene.world();
  const double scale = world.space.scale; // render areas
  for (const float keep : {1.0f, 0.3f}) {
    PhotonPassSettings pass = settings(4000, 0);
    pass.store_probability = keep;
    const auto sums =
        power_sums(world, pass, 40, [&](const Vec3f& p) { return sigma_at(world, p); });
    test::expect_mean(sums[0], (1 - std::exp(-3.0)) * scale * scale);
  }
  // And by depth: the upper half takes 1 - exp(-1.5).
  const auto upper = power_sums(world, settings(4000, 0), 40,
                                [&](const Vec3f& p) { return p.z > 0 ? sigma_at(world, p) : 0; });
  test::expect_mean(upper[0], (1 - std::exp(-1.5)) * scale * scale);
}

TEST(PhotonTracing, ScatterPhotonsCarryTheScatteredFlux) {
  MemoryScene scene = cube(3, {0.8f, 0.5f, 0.2f});
  scene.scene.lights.push_back(sun());
  const World world = scene.world();
  PhotonPassSettings pass = settings(4000, 0);
  pass.store = PhotonStore::scatter;
  pass.max_bounces = 1;
  const auto sums = power_sums(world, pass, 40, [](const Vec3f&) { return 1; });
  for (int c = 0; c < 3; ++c)
    test::expect_mean(sums[static_cast<std::size_t>(c)],
                      static_cast<double>(world.medium.volumes[0].albedo[c]) *
                          (1 - std::exp(-3.0)) * world.space.scale * world.space.scale);
}

// Where nothing is absorbed, constant radiance 1 all around makes a fluence of 4 pi everywhere.
void expect_furnace(const World& world, PhotonPassSettings pass, int passes, double volume) {
  const auto sums = power_sums(world, pass, passes, [](const Vec3f&) { return 1; });
  for (std::size_t c = 0; c < 3; ++c)
    test::expect_mean(sums[c], 4 * std::numbers::pi * volume);
}

TEST(PhotonTracing, FurnaceFluenceIsUniform) {
  for (const double extinction : {0.1, 1.0, 20.0}) {
    SCOPED_TRACE(extinction);
    MemoryScene scene = cube(extinction, Rgb(1));
    scene.scene.volumes[0].phase = test::henyey_greenstein(0.5);
    scene.add_light(LightType::environment);
    expect_furnace(scene.world(), settings(1000, 0), 40, 1);
  }
}

TEST(PhotonTracing, FurnaceInOverlappingHeterogeneousVolumes) {
  MemoryScene scene;
  const Vec3<int> cells{3, 3, 3};
  scene
      .add(test::closed_field(
               cells, [](int i, int j, int k) { return 1e-3 + test::lattice_noise(i, j, k); }),
           test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)))
      .extinction = 5;
  scene
      .add(test::uniform_field({1, 1, 1}, 1),
           test::turn({1, 2, 3}, 40).after(test::box_map({1, 1, 1}, Vec3d(-0.2), Vec3d(0.2))))
      .extinction = 10;
  scene.add_light(LightType::environment);
  // The second lies inside the first.
  expect_furnace(scene.world(), settings(2000, 0), 40, 1);
}

TEST(PhotonTracing, FurnaceWithChromaticExtinction) {
  MemoryScene scene = cube(8, Rgb(1));
  scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0.1f};
  scene.add_light(LightType::environment);
  expect_furnace(scene.world(), settings(2000, 0), 40, 1);
}

// Each collision takes 1 - albedo of the flux. In the end all of it is absorbed or has left, and
// nothing comes from nowhere: absorbed = collisions * (1 - albedo) <= incident power.
TEST(PhotonTracing, EnergyBalance) {
  MemoryScene scene = cube(5, {0.9f, 0.5f, 0.99f});
  scene.scene.lights.push_back(sun());
  const World world = scene.world();
  const double area = world.space.scale * world.space.scale;
  PhotonPassSettings absorbed = settings(4000, 0), scattered = absorbed;
  scattered.store = PhotonStore::scatter;
  const auto collided =
      power_sums(world, absorbed, 40, [&](const Vec3f& p) { return sigma_at(world, p); });
  const auto out = power_sums(world, scattered, 40, [](const Vec3f&) { return 1; });
  for (std::size_t c = 0; c < 3; ++c) {
    const double albedo = static_cast<double>(world.medium.volumes[0].albedo[static_cast<int>(c)]);
    // The same rate by both ways of storing.
    EXPECT_NEAR(out[c].mean(), collided[c].mean() * albedo,
                test::student_limit(40) * std::hypot(out[c].error(), collided[c].error() * albedo));
    EXPECT_LT(collided[c].mean() * (1 - albedo), area);
    EXPECT_GT(collided[c].mean(), (1 - std::exp(-5.0)) * area * 0.99);
  }
}

TEST(PhotonTracing, SkippedFirstFlightsAndTheStoredOnesAddUp) {
  MemoryScene scene = cube(4, Rgb(0.8f));
  scene.scene.lights.push_back(sun());
  const World world = scene.world();
  const auto whole = [](const Vec3f&) { return 1; };
  PhotonPassSettings all = settings(4000, 0), later = all, first = all;
  later.skip_first_flight = {true};
  first.max_bounces = 1;
  const auto a = power_sums(world, all, 40, whole), b = power_sums(world, later, 40, whole),
             c = power_sums(world, first, 40, whole);
  EXPECT_NEAR(a[0].mean(), b[0].mean() + c[0].mean(),
              test::student_limit(40) * std::hypot(a[0].error(), b[0].error(), c[0].error()));
  EXPECT_GT(c[0].mean(), 0);
  EXPECT_GT(b[0].mean(), 0);
}

TEST(PhotonTracing, SameListForAnyNumberOfThreads) {
  MemoryScene scene = cube(4, {0.9f, 0.8f, 0.7f});
  scene.scene.lights.push_back(sun());
  scene.add_light(LightType::environment);
  const World world = scene.world();
  PhotonPassSettings pass = settings(5000, 3);
  pass.skip_first_flight = {true, false};
  std::vector<PhotonList> lists;
  for (const std::size_t threads : {std::size_t{1}, std::size_t{2}, std::size_t{5}}) {
    tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    lists.push_back(trace_photons(world, pass).photons);
  }
  ASSERT_GT(lists[0].size(), 1000u);
  for (const PhotonList& list : lists) {
    EXPECT_EQ(list.position, lists[0].position);
    EXPECT_EQ(list.direction, lists[0].direction);
    EXPECT_EQ(list.power, lists[0].power);
  }
}

TEST(PhotonTracing, NothingToDo) {
  MemoryScene dark = cube(4, Rgb(1));
  EXPECT_EQ(trace_photons(dark.world(), settings(100, 0)).photons.size(), 0u);
  LightSettings black = sun();
  black.irradiance = Rgb(0);
  dark.scene.lights.push_back(black);
  const PhotonPassSettings pass = settings(100, 0);
  EXPECT_EQ(trace_photons(dark.world(), pass).photons.size(), 0u);
  MemoryScene empty;
  empty.scene.lights.push_back(sun());
  EXPECT_EQ(trace_photons(empty.world(), pass).photons.size(), 0u);
}

/// What there is would be of no use, and to put it together takes long.
TEST(PhotonTracing, LeavesNoPhotonsWhereItWasStopped) {
  const MemoryScene scene = [] {
    MemoryScene made = cube(5, Rgb(0.9f));
    made.add_light(LightType::distant).direction = {0, 0, -1};
    return made;
  }();
  const World world = scene.world();
  PhotonPassSettings pass = settings(1000, 0);
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  EXPECT_GT(trace_photons(world, pass).photons.size(), 0u);
  pass.stop = &stop;
  EXPECT_EQ(trace_photons(world, pass).photons.size(), 0u);
}

} // namespace
} // namespace vdbeam
