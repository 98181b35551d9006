#include "transport/world.h"

#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::MemoryScene;

TEST(Camera, MapsPixelsToDirections) {
  CameraSettings settings;
  settings.position = {1, 2, 3};
  settings.look_at = {1, 2, -7};
  settings.up = {0, 1, 0.3};
  settings.fov = 60;
  const Camera camera(settings, {200, 100}, {{1, 1, 1}, 2});
  const auto near = [](const Vec3d& a, const Vec3d& b) { return length(a - b) < 1e-12; };
  EXPECT_TRUE(near(camera.origin(), {0, 2, 4}));
  EXPECT_TRUE(near(camera.ray(100, 50).direction, {0, 0, -1}));
  const double tan_half = std::tan(std::numbers::pi / 6);
  // The upper edge lies half the field of view above; pixels are square.
  EXPECT_TRUE(near(camera.ray(100, 0).direction, normalize(Vec3d(0, tan_half, -1))));
  EXPECT_TRUE(near(camera.ray(200, 50).direction, normalize(Vec3d(2 * tan_half, 0, -1))));
  EXPECT_TRUE(near(camera.ray(0, 100).direction, normalize(Vec3d(-2 * tan_half, -tan_half, -1))));
}

/// A noisy box lit from a side, seen from another.
MemoryScene noisy_scene() {
  MemoryScene scene;
  const Vec3<int> cells{2, 3, 2};
  const auto value = [](int i, int j, int k) { return test::lattice_noise(i, j, k); };
  VolumeSettings& volume = scene.add(test::closed_field(cells, value),
                                     test::box_map(cells, {-0.4, -0.6, -0.4}, {0.4, 0.6, 0.4}));
  volume.extinction = 6;
  volume.albedo = {0.95f, 0.8f, 0.6f};
  volume.phase = test::henyey_greenstein(0.5);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {1, -0.6, -0.2};
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {0.3, 0.9, 0.8};
  scene.add_light(LightType::environment).radiance = {0.1f, 0.2f, 0.3f};
  scene.look({0.4, 0.5, 3}, {0.05, 0.02, 0}, 30, 12, 12);
  return scene;
}

/// The scene moved as a whole by a similarity.
MemoryScene moved(MemoryScene scene, const Affine& motion) {
  for (VolumeSettings& volume : scene.scene.volumes) {
    Affine own;
    for (std::size_t r = 0; r < 3; ++r) {
      own.rows[r] = {volume.transform[4 * r], volume.transform[4 * r + 1],
                     volume.transform[4 * r + 2]};
      own.translation[static_cast<int>(r)] = volume.transform[4 * r + 3];
    }
    own = motion.after(own);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        volume.transform[4 * r + c] = own.rows[r][static_cast<int>(c)];
      volume.transform[4 * r + 3] = own.translation[static_cast<int>(r)];
    }
  }
  for (LightSettings& light : scene.scene.lights) {
    light.direction = motion.vector(light.direction);
    light.position = motion.point(light.position);
  }
  CameraSettings& camera = scene.scene.camera;
  camera.position = motion.point(camera.position);
  camera.look_at = motion.point(camera.look_at);
  camera.up = motion.vector(camera.up);
  return scene;
}

std::vector<Rgb> picture(const MemoryScene& scene, int passes) {
  return test::render_passes(scene, EstimatorType::path, passes).pixels;
}

TEST(World, FarFromTheOriginItIsTheSamePicture) {
  const MemoryScene scene = noisy_scene();
  Affine away;
  away.translation = {1e6, -3e5, 2e6};
  const std::vector<Rgb> here = picture(scene, 2), there = picture(moved(scene, away), 2);
  int different = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
    for (int c = 0; c < 3; ++c)
      different += std::abs(here[i][c] - there[i][c]) > 2e-3f * (here[i][c] + 0.01f);
  // Rounding may turn one decision of a path, and all that follows.
  EXPECT_LE(different, static_cast<int>(here.size()) * 3 / 50);
}

TEST(World, ScaledByAPowerOfTwoItIsTheSamePictureBitForBit) {
  MemoryScene scene = noisy_scene();
  Affine grow;
  for (std::size_t a = 0; a < 3; ++a)
    grow.rows[a] = grow.rows[a] * 1024.0;
  MemoryScene large = moved(scene, grow);
  large.scene.volumes[0].extinction /= 1024;
  for (int c = 0; c < 3; ++c)
    large.scene.lights[1].intensity[c] *= 1024 * 1024;
  EXPECT_EQ(picture(scene, 1), picture(large, 1));
}

/// Same pixels up to noise: each pixel's spread is taken from its passes.
void expect_same_picture(const MemoryScene& a, const MemoryScene& b) {
  const test::PassMeans x = test::render_passes(a, EstimatorType::path, 48);
  const test::PassMeans y = test::render_passes(b, EstimatorType::path, 48);
  for (std::size_t c = 0; c < 3; ++c) {
    test::expect_same_mean(x.direct[c], y.direct[c]);
    test::expect_same_mean(x.indirect[c], y.indirect[c]);
    test::expect_same_mean(x.background[c], y.background[c]);
  }
  test::expect_same_mean(x.opacity, y.opacity);
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    difference += static_cast<double>(std::abs(x.pixels[i].x - y.pixels[i].x));
    sum += static_cast<double>(x.pixels[i].x);
  }
  EXPECT_LT(difference, 0.05 * sum); // a mirrored picture would differ by far more
}

TEST(World, TurnedWithCameraAndLightsItIsTheSamePicture) {
  const MemoryScene scene = noisy_scene();
  Affine motion = test::turn({1, -2, 0.5}, 73);
  motion.translation = {3, 1, -2};
  expect_same_picture(scene, moved(scene, motion));
}

/// The volume stays where it is; only its lattice is described in mirrored index axes, or its
/// density is given on a sheared lattice.
TEST(World, MirroredLatticeOfTheSameVolume) {
  const MemoryScene scene = noisy_scene();
  MemoryScene mirrored = scene;
  const Vec3<int> cells{2, 3, 2};
  mirrored.grids[0].field = test::closed_field(
      cells, [](int i, int j, int k) { return test::lattice_noise(16 - i, j, k); });
  mirrored.grids[0].index_to_world = test::box_map(cells, {0.4, -0.6, -0.4}, {-0.4, 0.6, 0.4});
  ASSERT_LT(mirrored.grids[0].index_to_world.determinant(), 0);
  expect_same_picture(scene, mirrored);
}

TEST(World, PermutedAxesOfTheSameVolume) {
  const MemoryScene scene = noisy_scene();
  MemoryScene permuted = scene;
  permuted.grids[0].field = test::closed_field(
      {3, 2, 2}, [](int i, int j, int k) { return test::lattice_noise(k, i, j); });
  // Index axis x runs along world y, y along z, z along x.
  Affine swap;
  swap.rows = {Vec3d{0, 0, 1}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}};
  permuted.grids[0].index_to_world =
      swap.after(test::box_map({3, 2, 2}, {-0.6, -0.4, -0.4}, {0.6, 0.4, 0.4}));
  expect_same_picture(scene, permuted);
}

/// Sheared: a homogeneous parallelepiped has the transmittance of its chord.
TEST(World, ShearedVolumeHasItsChord) {
  MemoryScene scene;
  Affine shear = test::box_map({1, 1, 1}, Vec3d(0), {1, 1, 1});
  shear.rows[0].y = 0.5 / 8; // x = i + j / 2
  shear.rows[2].x = 0.25 / 8;
  VolumeSettings& volume = scene.add(test::uniform_field({1, 1, 1}, 2), shear);
  volume.extinction = 1.5;
  volume.albedo = Rgb(0);
  scene.add_light(LightType::environment);
  // Along +y at (x, z) = (0.75, 0.6): i in [0, 1] and z - i / 4 in [0, 1] hold for y in [0, 1].
  scene.look({0.75, -3, 0.6}, {0.75, 1, 0.6}, 1e-3, 1, 1);
  const test::PassMeans means = test::render_passes(scene, EstimatorType::path, 4);
  EXPECT_NEAR(means.total[0].mean(), std::exp(-3.0), 1e-4 * std::exp(-3.0));
  // Along +x at (y, z) = (0.5, 0.2): i from 0 until z = i / 4 leaves nothing below, at i = 0.8.
  scene.look({-3, 0.5, 0.2}, {1, 0.5, 0.2}, 1e-3, 1, 1);
  const test::PassMeans across = test::render_passes(scene, EstimatorType::path, 4);
  EXPECT_NEAR(across.total[0].mean(), std::exp(-2.4), 1e-3 * std::exp(-2.4));
}

TEST(World, VolumesWithoutContentAreLeftOut) {
  MemoryScene scene = noisy_scene();
  scene.add(DensityField(), Affine());
  scene.add_box({5, 5, 5}, {6, 6, 6}).extinction = 0;
  WorldFacts facts;
  const World world = scene.world(&facts);
  EXPECT_EQ(world.medium.volumes.size(), 1u);
  ASSERT_EQ(facts.volumes.size(), 3u);
  EXPECT_EQ(facts.volumes[1].density, 0u);
}

TEST(World, EqualPhaseFunctionsShareAGroup) {
  MemoryScene scene;
  for (const double g : {0.3, 0.5, 0.3})
    scene.add_box(Vec3d(-0.5), Vec3d(0.5)).phase = test::henyey_greenstein(g);
  const World world = scene.world();
  EXPECT_EQ(world.medium.phases.size(), 2u);
  EXPECT_EQ(world.medium.volumes[0].phase_index, world.medium.volumes[2].phase_index);
  EXPECT_NE(world.medium.volumes[0].phase_index, world.medium.volumes[1].phase_index);
}

} // namespace
} // namespace vdbeam
