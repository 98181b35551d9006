// Air between the camera and a scene, by every estimator.
#include "lights/sky/aerial_perspective.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;
using namespace test::surfaces;

const std::vector<EstimatorType> estimators{EstimatorType::path, EstimatorType::beam,
                                            EstimatorType::march, EstimatorType::gather};

/// Adds the air; `irradiance` of its sun, 0 for air without light.
LightSettings& add_air(MemoryScene& scene, float irradiance, double metres_per_unit) {
  LightSettings& air = scene.add_light(LightType::atmosphere);
  air.direction = {-0.5, -0.6, 0.3};
  air.irradiance = Rgb(irradiance);
  air.aerosol = 0.4;
  air.metres_per_unit = metres_per_unit;
  air.altitude = 100;
  return air;
}

/// The air of a scene, with distances in world units.
AerialPerspective air_of_scene(const MemoryScene& scene) {
  return {lights_at_camera(scene.scene)[0], scene.scene.camera.up, {}};
}

Vec3d towards(const MemoryScene& scene) {
  return normalize(scene.scene.camera.look_at - scene.scene.camera.position);
}

/// Single scattering in a long box that is lit from the camera's side: the integral of sigma_s p E
/// exp(-2 sigma t) T(t), T being the transmittance of the air.
TEST(AerialPerspectiveLaws, ScatteredLightIsDimmedWhereItIsScattered) {
  constexpr double sigma = 0.05, begin = 40, end = 60;
  MemoryScene scene;
  scene.add_box({-400, -400, -end}, {400, 400, -begin}).extinction = sigma;
  scene.look({0, 0, 0}, {0, 0, -1}, 0.01, 2, 2);
  add_air(scene, 0, 200);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, 0, -1};
  sun.irradiance = Rgb(5);
  scene.scene.render.max_bounces = 1;
  const RayAir air = air_of_scene(scene).along(towards(scene), 0);
  Vec3d expected;
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const double t = begin + (end - begin) * (i + 0.5) / steps;
    expected += Vec3d(air.left(static_cast<float>(t))) *
                (sigma * 5 / (4 * std::numbers::pi) * std::exp(-2 * sigma * (t - begin)) *
                 (end - begin) / steps);
  }
  ASSERT_LT(air.left(begin).z, 0.6f);
  for (const EstimatorType& estimator : estimators) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 64);
    for (std::size_t c = 0; c < 3; ++c) {
      expect_mean(means.total[c], expected[static_cast<int>(c)],
                  0.01 * expected[static_cast<int>(c)]);
      expect_power(means.total[c], 0.02 * means.total[c].mean());
    }
  }
}

/// The same with the photons of the sun, where they, not shadow rays, carry the light.
TEST(AerialPerspectiveLaws, LightOfPhotonsIsDimmedToo) {
  MemoryScene scene;
  scene.add_box({-4, -4, -54}, {4, 4, -46}).extinction = 0.5;
  scene.look({0, 0, 0}, {0, 0, -50}, 4, 8, 8);
  add_air(scene, 0, 200);
  scene.scene.render.photons = 20000;
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {-0.5, -0.7, -0.3};
  sun.irradiance = Rgb(5);
  const PassMeans path = render_passes(scene, EstimatorType::path, 300);
  for (const char* direct : {"sampled", "photons"})
    for (const EstimatorType& estimator :
         {EstimatorType::beam, EstimatorType::march, EstimatorType::gather}) {
      SCOPED_TRACE(std::string(estimator.name) + direct);
      scene.scene.render.direct = direct[0] == 's' ? DirectLight::sampled : DirectLight::photons;
      const PassMeans means = render_passes(scene, estimator, 24);
      for (std::size_t c = 0; c < 3; ++c) {
        expect_same_mean(means.total[c], path.total[c], 0.03 * path.total[c].mean());
        expect_power(means.total[c], 0.02 * means.total[c].mean());
      }
    }
}

/// Emission, surfaces, and the light of the air before what is opaque.
TEST(AerialPerspectiveLaws, EmissionAndSurfaces) {
  MemoryScene scene;
  scene.look({0, 0, 0}, {0, 0, -1}, 0.01, 2, 2);
  add_air(scene, 3, 100);
  add_surface(scene, SurfaceShape::quad, moved(scaled(100), {0, 0, -80}), shining(2));
  const RayAir air = air_of_scene(scene).along(towards(scene), 0);
  const RayAir::Seen seen = air.at(80);
  for (const EstimatorType& estimator : estimators) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 2);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(means.total[static_cast<std::size_t>(c)].mean(), 2 * seen.left[c] + seen.light[c],
                  2e-4);
  }
  // Black fog in front of it hides both by so much.
  VolumeSettings& fog = scene.add_box({-400, -400, -60}, {400, 400, -58});
  fog.extinction = 0.5;
  fog.albedo = Rgb(0);
  const double tr = std::exp(-1.0);
  const RayAir::Seen at_fog = air.at(58.8f); // where it hides the air, on average
  for (const EstimatorType& estimator : estimators) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 2);
    EXPECT_NEAR(means.opacity.mean(), 1, 1e-5);
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      EXPECT_NEAR(means.direct[i].mean(), at_fog.light[c] * (1 - tr), 2e-3 * at_fog.light[c]);
      EXPECT_NEAR(means.background[i].mean(), (2 * seen.left[c] + seen.light[c]) * tr, 2e-4);
    }
  }
}

/// A cloud under sky and sun behind kilometres of air: one answer, in groups too.
TEST(AerialPerspectiveLaws, EstimatorsAgree) {
  MemoryScene scene;
  VolumeSettings& cloud = scene.add_box({-1, -1, -31}, {1, 1, -29});
  cloud.extinction = 3;
  cloud.albedo = Rgb(0.98f);
  cloud.phase = henyey_greenstein(0.7);
  scene.look({0, 0.2, 0}, {0, 0, -30}, 5, 12, 12);
  add_air(scene, 3, 300).group = "sky";
  scene.scene.lights[0].exposure = 1;
  scene.add_light(LightType::environment).radiance = Rgb(0.3f);
  scene.scene.lights[1].visible = false;
  scene.scene.render.photons = 30000;
  const PassMeans path = render_passes(scene, EstimatorType::path, 64);
  expect_power(path.total[0], 0.001 * path.total[0].mean());
  for (const EstimatorType& estimator :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::gather}) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 12);
    expect_power(means.total[0], 0.001 * means.total[0].mean());
    for (std::size_t c = 0; c < 3; ++c)
      expect_same_mean(means.total[c], path.total[c], 0.02 * path.total[c].mean());
    EXPECT_EQ(regions_apart(means, path, 0.05), 0);
  }
}

/// A plane without end fades into the sky: nothing marks the horizon.
TEST(AerialPerspectiveLaws, NoSeamAtTheHorizon) {
  MemoryScene scene;
  constexpr int rows = 64;
  scene.look({0, 2, 0}, {0, 2, -1}, 0.02, 2, rows); // the foot is 11 km away
  LightSettings& air = add_air(scene, 3, 1);
  air.altitude = 0;
  air.aerosol = 0.1;
  MaterialSettings dark = diffuse(0.05);
  SurfaceSettings& ground = add_surface(scene, SurfaceShape::plane, scaled(1), dark);
  ground.transform = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0}; // its normal is +y
  const PassMeans means = render_passes(scene, EstimatorType::path, 64);
  // Between a row and the next, a 64th of 0.02 degrees lower, light changes by little everywhere.
  for (int y = 1; y < rows; ++y) {
    const Rgb above = means.pixels[static_cast<std::size_t>(2 * (y - 1))];
    const Rgb below = means.pixels[static_cast<std::size_t>(2 * y)];
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(below[c] / above[c], 1, 0.03) << y;
  }
  const Rgb sky = means.pixels[0], foot = means.pixels[2 * (rows - 1)];
  EXPECT_LT(foot.y, 0.7f * sky.y); // it is the ground that fades
}

} // namespace
} // namespace vdbeam
