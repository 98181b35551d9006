#include "lights/volume_light.h"
#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

#include <numbers>

namespace vdbeam {
namespace {

using namespace test;

const Vec3<int> cells{2, 3, 2};

/// Blobs in a box that is turned, sheared by nobody, and mirrored.
MemoryScene fire() {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1));
  Affine mirror;
  mirror.rows[0].x = -1;
  const auto value = [](int i, int j, int k) {
    const double u = lattice_noise(i, j, k);
    return i < 8 && k < 8 ? 0.0 : u * u * u;
  };
  EmissionSettings& emission =
      scene.glow(closed_field(cells, value),
                 mirror.after(turn({1, 1, 0}, 35)).after(box_map(cells, {0, 0, 0}, {1, 1.5, 0.5})));
  emission.scale = 3;
  emission.color = {1, 0.5f, 0.125f};
  return scene;
}

/// 4 pi times the integral of j over the volume: the trilinear field's, by its lattice values with
/// the weights 1 inside, 1/2 on faces, 1/4 on edges and 1/8 at corners.
TEST(VolumeLight, PowerIsTheQuadrature) {
  const MemoryScene scene = fire();
  const World world = scene.world();
  ASSERT_EQ(world.lights.size(), 1u);
  double sum = 0;
  for (int i = 0; i <= 16; ++i)
    for (int j = 0; j <= 24; ++j)
      for (int k = 0; k <= 16; ++k) {
        const double u = lattice_noise(i, j, k);
        const auto weight = [](int at, int last) { return at == 0 || at == last ? 0.5 : 1.0; };
        if (!(i < 8 && k < 8))
          sum += u * u * u * weight(i, 16) * weight(j, 24) * weight(k, 16);
      }
  const double volume = 1 * 1.5 * 0.5 / (16 * 24 * 16);
  const double scale = world.space.scale; // power per render unit of j: lengths squared
  const double expected = 4 * std::numbers::pi * 3 * sum * volume * scale * scale;
  const Rgb power = world.lights[0].power();
  EXPECT_NEAR(static_cast<double>(power.x) / expected, 1, 1e-5);
  EXPECT_NEAR(static_cast<double>(power.y) / expected, 0.5, 1e-5);
  EXPECT_NEAR(static_cast<double>(power.z) / expected, 0.125, 1e-5);
}

/// The mean photon carries the power; its place and direction have the right moments; no photon
/// weighs much more than another.
TEST(VolumeLight, PhotonsStandForTheField) {
  const MemoryScene scene = fire();
  const World world = scene.world();
  const Light& light = world.lights[0];
  const Emitter& emitter = world.medium.emitters[0];
  const double power = static_cast<double>(light.power().x);
  Samples flux, upper, forward, square;
  double largest = 0;
  constexpr int count = 40000;
  for (int i = 0; i < count; ++i) {
    Rng rng({}, RngStage::test, static_cast<std::uint64_t>(i));
    const EmittedPhoton photon = light.emit((i + 0.5) / count, rng);
    const double weight = static_cast<double>(photon.flux.x) / power;
    const Vec3f local = emitter.local_point(photon.ray.origin);
    flux.add(weight);
    largest = std::max(largest, weight);
    upper.add(local.y > 12 ? weight : 0);
    forward.add(static_cast<double>(photon.ray.direction.z));
    square.add(static_cast<double>(photon.ray.direction.x * photon.ray.direction.x));
    EXPECT_NEAR(length(photon.ray.direction), 1, 1e-5);
  }
  expect_mean(flux, 1);
  EXPECT_LT(flux.error(), 0.01);
  EXPECT_LT(largest, 8.1);
  expect_mean(forward, 0);
  expect_mean(square, 1.0 / 3);
  double above = 0, all = 0;
  for (int i = 0; i < 32; ++i)
    for (int j = 0; j < 48; ++j)
      for (int k = 0; k < 32; ++k) { // 8 points in each cube integrate a trilinear function exactly
        const Vec3f p{(static_cast<float>(i) + 0.5f) / 2, (static_cast<float>(j) + 0.5f) / 2,
                      (static_cast<float>(k) + 0.5f) / 2};
        const Vec3<int> cell{static_cast<int>(p.x) / 8, static_cast<int>(p.y) / 8,
                             static_cast<int>(p.z) / 8};
        const std::int32_t entry = emitter.field->cell(cell.x, cell.y, cell.z);
        if (entry == DensityField::empty_cell)
          continue;
        const double j_here =
            static_cast<double>(emitter.field->sample_cell(entry, p - Vec3f(cell * 8)).x);
        all += j_here;
        above += p.y > 12 ? j_here : 0;
      }
  expect_mean(upper, above / all);
}

TEST(VolumeLight, UniformCells) {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1));
  scene.glow(uniform_field({2, 1, 1}, 4), box_map({2, 1, 1}, {0, 0, 0}, {1, 1, 1}));
  const World world = scene.world();
  const double scale = world.space.scale;
  EXPECT_NEAR(static_cast<double>(world.lights[0].power().x), 16 * std::numbers::pi * scale * scale,
              1e-4 * 16 * std::numbers::pi);
  Samples x;
  for (int i = 0; i < 2000; ++i) {
    Rng rng({}, RngStage::test, static_cast<std::uint64_t>(i));
    const EmittedPhoton photon = world.lights[0].emit((i + 0.5) / 2000, rng);
    EXPECT_NEAR(photon.flux.x / world.lights[0].power().x, 1, 1e-5);
    x.add(static_cast<double>(world.medium.emitters[0].local_point(photon.ray.origin).x));
  }
  expect_mean(x, 8);
}

/// Shadow rays and escaping rays find nothing of it.
TEST(VolumeLight, IsForPhotonsAlone) {
  const World world = fire().world();
  const Light& light = world.lights[0];
  EXPECT_EQ(light.sample_incident({}, 0.5f, 0.5f).value, Rgb());
  EXPECT_EQ(light.emitted_radiance({{{}, {0, 0, 1}}}).radiance, Rgb());
}

TEST(VolumeLight, ShinesOnNothingThatDoesNotScatter) {
  MemoryScene scene = fire();
  scene.scene.volumes[0].albedo = Rgb(0);
  EXPECT_EQ(scene.world().lights.size(), 0u);
  EXPECT_EQ(scene.world().medium.emitters.size(), 1u);
}

} // namespace
} // namespace vdbeam
