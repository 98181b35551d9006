// Volumes without a file obey the laws that those of files obey, by every estimator.
#include "support/fog_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

MemoryScene fog_scene(VolumeShape shape, double extinction, bool noisy = false) {
  MemoryScene scene;
  VolumeSettings volume = fog(shape, {-1, -0.6, -1}, {1, 1.4, 1}, extinction);
  volume.fog.scale_height = 0.5;
  volume.noise.amplitude = noisy ? 0.15 : 0;
  add_fog(scene, volume);
  scene.scene.render.photons = 20000;
  scene.look({0.4, 0.9, 4}, {0, 0, 0}, 30, 12, 12);
  return scene;
}

const std::vector<EstimatorType> estimators_in_fog{EstimatorType::path, EstimatorType::beam,
                                                   EstimatorType::march, EstimatorType::gather};

class FogLaws : public ::testing::TestWithParam<VolumeShape> {};

TEST_P(FogLaws, WhiteFurnace) {
  for (const bool noisy : {false, true}) {
    MemoryScene scene = fog_scene(GetParam(), 3, noisy);
    scene.add_light(LightType::environment);
    for (const EstimatorType& estimator : estimators_in_fog) {
      SCOPED_TRACE(estimator.name);
      const PassMeans means = render_passes(scene, estimator, 16);
      expect_mean(means.total[0], 1, estimator == EstimatorType::path ? 0 : 0.02);
      expect_power(means.total[0], 0.01);
    }
  }
}

/// A sun, a lamp beside the fog and a sky: one answer, region by region.
TEST_P(FogLaws, EstimatorsAgree) {
  MemoryScene scene = fog_scene(GetParam(), 2.5, true);
  scene.scene.volumes[0].albedo = {0.95f, 0.9f, 0.8f};
  scene.scene.volumes[0].phase = henyey_greenstein(0.5);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {-0.5, -0.7, -0.3};
  sun.irradiance = Rgb(2);
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {1.4, 0.8, 0.9};
  lamp.power = Rgb(20);
  scene.add_light(LightType::environment).radiance = Rgb(0.1f);
  const PassMeans path = render_passes(scene, EstimatorType::path, 80);
  expect_power(path.total[0], 0.005 * path.total[0].mean());
  for (const EstimatorType& estimator :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::gather}) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 16);
    expect_power(means.total[0], 0.008 * means.total[0].mean());
    expect_same_mean(means.total[0], path.total[0], 0.02 * path.total[0].mean());
    EXPECT_EQ(regions_apart(means, path, 0.06), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, FogLaws,
                         ::testing::Values(VolumeShape::box, VolumeShape::sphere,
                                           VolumeShape::height));

/// Under a sky of 1, fog that absorbs all shows its transmittance.
TEST(FogLaws, WhatAbsorbsShowsItsTransmittance) {
  MemoryScene scene = fog_scene(VolumeShape::box, 0.4);
  scene.scene.volumes[0].albedo = Rgb(0);
  scene.add_light(LightType::environment);
  scene.look({0.3, 0.2, 100}, {0.3, 0.2, 0}, 0.001, 1, 1);
  for (const EstimatorType& estimator : estimators_in_fog) {
    const PassMeans means = render_passes(scene, estimator, 2);
    EXPECT_NEAR(means.total[0].mean(), std::exp(-0.8), 1e-5) << estimator.name;
    EXPECT_NEAR(means.opacity.mean(), 1 - std::exp(-0.8), 1e-5) << estimator.name;
  }
}

/// The camera stands in a fog that is 20,000 units wide; a lamp hangs 30 units before it.
TEST(FogLaws, AroundTheCamera) {
  MemoryScene scene;
  VolumeSettings volume = fog(VolumeShape::height, {-10000, 0, -10000}, {10000, 5000, 10000}, 0.01);
  volume.fog.scale_height = 800;
  volume.albedo = Rgb(0.9f);
  add_fog(scene, volume);
  scene.scene.render.photons = 40000;
  scene.look({0, 20, 0}, {0, 20, -1}, 40, 12, 12);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0.3, -1, 0.2};
  sun.irradiance = Rgb(2);
  LightSettings& lamp = scene.add_light(LightType::point);
  lamp.position = {3, 24, -30};
  lamp.power = Rgb(5000);
  const PassMeans path = render_passes(scene, EstimatorType::path, 300);
  expect_power(path.total[0], 0.02 * path.total[0].mean());
  for (const EstimatorType& estimator : {EstimatorType::beam, EstimatorType::gather}) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 32);
    expect_same_mean(means.total[0], path.total[0], 0.03 * path.total[0].mean());
  }
}

/// Extinctions of 1e-9 and 1e6 per unit: as good as nothing, and as good as a wall.
TEST(FogLaws, FromHardlyAnyToAWall) {
  for (const double extinction : {1e-9, 1e6}) {
    SCOPED_TRACE(extinction);
    MemoryScene scene = fog_scene(VolumeShape::box, extinction);
    scene.scene.volumes[0].albedo = Rgb(0.5f);
    scene.add_light(LightType::environment);
    scene.look({0.3, 0.2, 100}, {0.3, 0.2, 0}, 0.5, 4, 4);
    for (const EstimatorType& estimator : {EstimatorType::path, EstimatorType::beam}) {
      const PassMeans means = render_passes(scene, estimator, 4);
      for (const Rgb& pixel : means.pixels)
        EXPECT_TRUE(std::isfinite(pixel.x));
      if (extinction < 1) {
        EXPECT_NEAR(means.total[0].mean(), 1, 1e-6) << estimator.name;
        continue;
      }
      EXPECT_NEAR(means.opacity.mean(), 1, 1e-6) << estimator.name;
      EXPECT_LT(means.total[0].mean(), 0.16) << estimator.name;
      // A half space of isotropic scatterers with this albedo shows about 0.12; photons cannot
      // resolve a skin of a millionth (docs/stability.md).
      if (estimator == EstimatorType::path) {
        EXPECT_GT(means.total[0].mean(), 0.08);
      }
    }
  }
}

} // namespace
} // namespace vdbeam
