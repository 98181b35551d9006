// Extreme coefficients with answers known in closed form.
#include "laws/adding_doubling.h"
#include "stability/stability_scene.h"

namespace vdbeam {
namespace {

using namespace test;

constexpr EstimatorType all_estimators[] = {EstimatorType::beam, EstimatorType::march,
                                            EstimatorType::path};

/// A thick box under a sun in the camera's back: radiance = irradiance albedo / (8 pi) H(1)^2
/// (Chandrasekhar, Radiative Transfer, 1950, ch. V).
double thick_slab_radiance(double albedo) {
  const double h = slab::h_function(albedo, 1);
  return albedo / (8 * std::numbers::pi) * h * h;
}

/// Beam's photons do not resolve so thin a lit skin, and render() says so; it stays sound and below
/// the truth.
TEST(Media, ThickUnderASun) {
  const double exact = thick_slab_radiance(0.8);
  for (const double depth : {1e3, 1e5, 1e6}) {
    MemoryScene scene = box_scene(depth, 0.8);
    scene.look({0, 0, 3}, {0, 0, 0}, 1, 8, 8);
    add_sun(scene, {0, 0, -1});
    SCOPED_TRACE(depth);
    const PassMeans path = render_sound(scene, EstimatorType::path, 24, "path");
    expect_mean(path.total[0], exact, 0.02 * exact);
    expect_power(path.total[0], 0.01 * exact);
    scene.scene.render.photons = 20000;
    const PassMeans beam = render_sound(scene, EstimatorType::beam, 4, "beam");
    // What is left is single scattering at least, which needs no photons.
    EXPECT_LT(beam.total[0].mean(), 1.1 * exact);
    EXPECT_GT(beam.total[0].mean(), 0.98 * 0.8 / (8 * std::numbers::pi));
  }
}

/// Here a mean free path is as long as single precision resolves; path loses 7 %, and render()
/// notes it (Limits.WhatPhotonsDoNotResolveIsNoted). Single scattering at 1e6 is exact: rounding
/// puts points beyond the face that the light comes through, where they must not count as vacuum.
TEST(Media, ThickerThanPrecision) {
  MemoryScene scene = box_scene(1e7, 0.8);
  scene.look({0, 0, 3}, {0, 0, 0}, 1, 8, 8);
  add_sun(scene, {0, 0, -1});
  const PassMeans path = render_sound(scene, EstimatorType::path, 24, "path");
  expect_mean(path.total[0], thick_slab_radiance(0.8), 0.1 * thick_slab_radiance(0.8));
  expect_power(path.total[0], 0.01 * thick_slab_radiance(0.8));
}

TEST(Media, SingleScatteringOfAThickMedium) {
  const double exact = 0.8 / (8 * std::numbers::pi);
  for (const double depth : {1e3, 1e6}) {
    MemoryScene scene = box_scene(depth, 0.8);
    scene.look({0, 0, 3}, {0, 0, 0}, 1, 8, 8);
    add_sun(scene, {0, 0, -1});
    scene.scene.render.max_bounces = 1;
    for (const EstimatorType type : {EstimatorType::beam, EstimatorType::path}) {
      SCOPED_TRACE(name_of(type) + " " + std::to_string(depth));
      const PassMeans means = render_sound(scene, type, 16, "single");
      expect_mean(means.total[0], exact, 0.005 * exact);
      expect_power(means.total[0], 0.01 * exact);
    }
  }
}

/// Nothing scatters: the sky is seen through the medium, exactly.
TEST(Media, AlbedoZero) {
  for (const EstimatorType type : all_estimators)
    for (const double depth : {1e-6, 1.0, 50.0, 1e7}) {
      MemoryScene scene = box_scene(depth, 0);
      scene.look({0, 0, 3}, {0, 0, 0}, 1e-4, 4, 4);
      add_sky(scene);
      add_sun(scene, {0, 0, -1});
      const PassMeans means = render_sound(scene, type, 1, "absorption");
      EXPECT_NEAR(means.total[0].mean(), std::exp(-depth), 1e-5 * std::exp(-depth))
          << name_of(type) << " " << depth;
      EXPECT_EQ(means.direct[0].mean() + means.indirect[0].mean(), 0);
    }
}

/// Albedo (1, 0.5, 0) in a furnace: red is white, blue absorbs, green lies between and is the same
/// for all estimators.
TEST(Media, AlbedoOfEachKind) {
  MemoryScene scene = box_scene(3);
  scene.look({0, 0, 3}, {0, 0, 0}, 1e-4, 8, 8);
  scene.scene.volumes[0].albedo = {1, 0.5f, 0};
  add_sky(scene);
  const PassMeans path = render_sound(scene, EstimatorType::path, 64, "path");
  for (const EstimatorType type : all_estimators) {
    SCOPED_TRACE(name_of(type));
    const PassMeans means = render_sound(scene, type, 16, "albedos");
    expect_mean(means.total[0], 1, type == EstimatorType::path ? 1e-4 : 0.03);
    expect_same_mean(means.total[1], path.total[1], 0.03 * path.total[1].mean());
    for (const std::size_t c : {0, 1})
      expect_power(means.total[c], 0.018 * path.total[c].mean());
    EXPECT_NEAR(means.total[2].mean(), std::exp(-3), 1e-6);
  }
}

/// A medium that is not there for blue, and dense for red: blue sees the sky, red and green the
/// furnace.
TEST(Media, ExtinctionZeroInOneChannel) {
  for (const double extinction : {2.0, 50.0}) {
    MemoryScene scene = box_scene(extinction);
    scene.scene.render.photons = 20000;
    scene.scene.volumes[0].extinction_scale = {1, 0.01f, 0};
    add_sky(scene);
    for (const EstimatorType type : all_estimators) {
      SCOPED_TRACE(name_of(type) + " " + std::to_string(extinction));
      const PassMeans means = render_sound(scene, type, 24, "two channels");
      const double bias = type == EstimatorType::path ? 1e-4 : 0.04;
      expect_mean(means.total[0], 1, bias);
      expect_mean(means.total[1], 1, bias);
      for (const std::size_t c : {0, 1})
        expect_power(means.total[c], 0.035);
      EXPECT_NEAR(means.total[2].mean(), 1, 1e-6);
      EXPECT_EQ(means.indirect[2].mean(), 0);
    }
  }
}

/// Channels of 1e3 : 1 : 1e-3. Spectral tracking bounds every channel's weight.
TEST(Media, ExtinctionsFarApart) {
  MemoryScene scene = box_scene(1e3);
  scene.scene.volumes[0].extinction_scale = {1, 1e-3f, 1e-6f};
  add_sky(scene);
  const PassMeans means = render_sound(scene, EstimatorType::path, 64, "path");
  for (std::size_t c = 0; c < 3; ++c) {
    expect_mean(means.total[c], 1, 1e-3);
    expect_power(means.total[c], 0.015);
  }
  scene.scene.render.photons = 5000;
  const PassMeans beam = render_sound(scene, EstimatorType::beam, 24, "beam");
  for (std::size_t c = 1; c < 3; ++c) {
    expect_mean(beam.total[c], 1, 0.04);
    expect_power(beam.total[c], 0.04);
  }
}

TEST(Media, ExtinctionZero) {
  MemoryScene scene = box_scene(0);
  add_sky(scene);
  for (const EstimatorType type : all_estimators)
    EXPECT_EQ(render_sound(scene, type, 1, "no extinction").total[0].mean(), 1);
}

TEST(Media, NoVolumeAtAll) {
  MemoryScene scene;
  scene.look({0, 0, 3}, {0, 0, 0}, 20, 8, 8);
  add_sky(scene, 0.25f);
  for (const EstimatorType type : all_estimators)
    EXPECT_EQ(render_sound(scene, type, 1, "empty").total[0].mean(), 0.25);
}

} // namespace
} // namespace vdbeam
