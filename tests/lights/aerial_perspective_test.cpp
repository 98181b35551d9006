// The air between camera and scene: against closed forms, an integral of its own, and the sky.
#include "lights/sky/aerial_perspective.h"
#include "support/degrees.h"

#include "lights/environment_image.h"
#include "lights/light_test_scene.h"
#include "lights/sky/air_colors.h"
#include "volume/blackbody.h"

namespace vdbeam {
namespace {

Atmosphere air_at(double altitude, double aerosol, double sun = 40, double ground_albedo = 0) {
  return Atmosphere({.sun_elevation = sun * degrees,
                     .aerosol = aerosol,
                     .ground_albedo = ground_albedo,
                     .altitude = altitude});
}

/// Extinction of air and haze at the ground [1/m] (docs/theory/transport.md).
double air_extinction(double nm) {
  const double l2 = nm * nm * 1e-6;
  return 0.008569 / (l2 * l2) * (1 + 0.0113 / l2 + 0.00013 / (l2 * l2)) / 8000;
}
double haze_extinction(double nm, double aerosol) {
  return aerosol * std::pow(nm / 550, -1.3) / 1200;
}

/// Mean over the visible light of a spectrum that is nearly flat, as the eye weighs it.
template <class Value>
double luminance(const Value& value) {
  double sum = 0, white = 0;
  for (int nm = 390; nm <= 710; nm += 20) {
    sum += color_matching(nm).y * value(nm);
    white += color_matching(nm).y;
  }
  return sum / white;
}

Atmosphere::Between between(const Atmosphere& air, double elevation, double azimuth,
                            double distance) {
  std::vector<double> distances;
  constexpr int steps = 200;
  for (int i = 1; i <= steps; ++i)
    distances.push_back(distance * i / steps);
  std::vector<Atmosphere::Between> result(distances.size());
  air.between(elevation * degrees, azimuth * degrees, distances, result);
  return result.back();
}

/// Level lines in air of one density, and lines straight up through layers.
TEST(AerialPerspective, TransmittanceInClosedForm) {
  for (const double aerosol : {0.0, 0.1, 0.5})
    for (const double distance : {500.0, 5000.0, 20000.0}) {
      const Atmosphere air = air_at(0, aerosol);
      const double level = luminance([&](double nm) {
        return std::exp(-(air_extinction(nm) + haze_extinction(nm, aerosol)) * distance);
      });
      EXPECT_NEAR(between(air, 0, 90, distance).left.y, level, 0.01) << aerosol << " " << distance;
      const double up = luminance([&](double nm) {
        return std::exp(-air_extinction(nm) * 8000 * (1 - std::exp(-distance / 8000)) -
                        haze_extinction(nm, aerosol) * 1200 * (1 - std::exp(-distance / 1200)));
      });
      // Ozone, which begins at 10 km, takes 1 % of it up there.
      EXPECT_NEAR(between(air, 90, 0, distance).left.y, up, distance > 1e4 ? 0.015 : 0.002)
          << aerosol << " " << distance;
    }
}

/// Single scattering of sunlight by the formula, and what has scattered before as the sky has it:
/// along a level line of sight over a black ground its source is the same everywhere.
TEST(AerialPerspective, LightAgainstAnIntegralOfItsOwn) {
  for (const double azimuth : {0.0, 90.0, 180.0})
    for (const double distance : {2000.0, 10000.0}) {
      const Atmosphere air = air_at(0, 0);
      const double mu = std::sin(40 * degrees),
                   cosine = std::cos(40 * degrees) * std::cos(azimuth * degrees);
      const double phase = 3 / (16 * std::numbers::pi) * (1 + cosine * cosine);
      const double single = luminance([&](double nm) {
        const double sigma = air_extinction(nm);
        return std::exp(-sigma * 8000 / mu) * phase * (1 - std::exp(-sigma * distance));
      });
      // The mean over all directions of the sky, below which is nothing.
      double sky = 0;
      constexpr int rows = 60, columns = 60;
      for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j)
          sky +=
              air.radiance(std::asin((i + 0.5) / rows), 2 * std::numbers::pi * (j + 0.5) / columns)
                  .y /
              (2 * rows * columns);
      // The sky is blue as air scatters: by the fourth power of the wavelength.
      const double blue = luminance([](double nm) { return std::pow(nm / 550, -4); });
      const double repeated = luminance([&](double nm) {
        return sky / blue * std::pow(nm / 550, -4) * (1 - std::exp(-air_extinction(nm) * distance));
      });
      const double light = between(air, 0, azimuth, distance).light.y;
      EXPECT_GT(light, single);
      EXPECT_NEAR(light, single + repeated, 0.05 * light) << azimuth << " " << distance;
    }
}

/// What is seen is the air up to a point, and what is seen from there through it: the sky.
TEST(AerialPerspective, AirBeforeAndBehindAPointIsTheSky) {
  constexpr double earth = 6360e3, distance = 4000;
  const double start = 500, elevation = 8;
  const Atmosphere here = air_at(start, 0.1, 40, 0.2);
  const double r = earth + start, sine = std::sin(elevation * degrees);
  const double there = std::sqrt(r * r + distance * distance + 2 * r * distance * sine);
  const double steeper = std::asin((r * sine + distance) / there);
  const Atmosphere beyond = air_at(there - earth, 0.1, 40, 0.2);
  const Atmosphere::Between air = between(here, elevation, 120, distance);
  const Vec3d sky = here.radiance(elevation * degrees, 120 * degrees);
  const Vec3d behind = beyond.radiance(steeper, 120 * degrees);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(air.light[c] + air.left[c] * behind[c], sky[c], 0.03 * sky[c]) << c;
}

LightSettings atmosphere(double aerosol = 0.1, double altitude = 2) {
  LightSettings light;
  light.type = LightType::atmosphere;
  light.direction = {-0.6, -0.5, -0.4};
  light.irradiance = Rgb(3);
  light.aerosol = aerosol;
  light.altitude = altitude;
  light.metres_per_unit = 10;
  return light;
}

/// The tables of a camera against the model, in any direction and at any distance.
TEST(AerialPerspective, TablesAgainstTheModel) {
  for (const double altitude : {2.0, 3000.0})
    for (const double aerosol : {0.05, 1.0}) {
      const LightSettings light = atmosphere(aerosol, altitude);
      const Vec3d up{0, 0, 1};
      const RenderSpace space{{5, 6, 7}, 0.25};
      const AerialPerspective perspective(light, up, space);
      const Atmosphere air(air_of(light, up));
      const AirColors colors(light);
      const Vec3d white = colors.rgb(air.unfiltered());
      Rng rng({1, 1, 1}, RngStage::test, 1);
      for (int i = 0; i < 200; ++i) {
        const double elevation = (rng.uniform() - 0.3) * 60, turn = rng.uniform() * 360;
        const double metres = std::exp(std::log(20.0) + rng.uniform() * std::log(4000.0));
        const std::array<Vec3d, 3> axes = environment_axes(up, 0);
        const Vec3d direction =
            (axes[0] * std::cos(turn * degrees) + axes[1] * std::sin(turn * degrees)) *
                std::cos(elevation * degrees) +
            axes[2] * std::sin(elevation * degrees);
        const Vec3d to_sun = -normalize(light.direction);
        const double from_sun =
            turn - std::atan2(dot(axes[1], to_sun), dot(axes[0], to_sun)) / degrees;
        const Atmosphere::Between exact = between(air, elevation, from_sun, metres);
        // Half of the way lies before the ray begins.
        const double whole = metres / 10 * space.scale;
        const RayAir along = perspective.along(direction, whole / 2);
        const RayAir::Seen seen = along.at(static_cast<float>(whole / 2));
        const Vec3d left = colors.rgb(exact.left);
        const Rgb added = colors(exact.light);
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(seen.left[c], std::max(0.0, left[c] / white[c]), 0.004)
              << elevation << " " << turn << " " << metres;
          EXPECT_NEAR(seen.light[c], added[c], 0.02f * added[c] + 1e-5f)
              << elevation << " " << turn << " " << metres;
          EXPECT_EQ(along.left(static_cast<float>(whole / 2))[c], seen.left[c]);
        }
      }
    }
}

/// Far away the air has the colour of the sky there, above the horizon and just below it.
TEST(AerialPerspective, FarAwayIsTheSky) {
  const LightSettings light = atmosphere();
  const Vec3d up{0, 1, 0};
  const AerialPerspective perspective(light, up, {});
  const Atmosphere air(air_of(light, up));
  const std::array<Vec3d, 3> axes = environment_axes(up, 0);
  const Vec3d to_sun = -normalize(light.direction);
  const double sun_turn = std::atan2(dot(axes[1], to_sun), dot(axes[0], to_sun));
  for (const double elevation : {60.0, 10.0, 1.0, 0.05})
    for (const double turn : {0.0, 1.0, 3.0}) {
      const double e = elevation * degrees;
      for (const double sign : {1.0, -1.0}) {
        if (sign < 0 && elevation > 0.1)
          continue;
        const Vec3d direction =
            (axes[0] * std::cos(turn) + axes[1] * std::sin(turn)) * std::cos(e) +
            axes[2] * (sign * std::sin(e));
        const RayAir::Seen seen = perspective.along(direction, 0).at(infinity);
        const Rgb sky = AirColors(light)(air.radiance(e, turn - sun_turn));
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(seen.light[c], sky[c], 0.02f * sky[c]) << elevation * sign << " " << turn;
      }
    }
}

TEST(AerialPerspective, AltitudeIsTheCameras) {
  Scene scene;
  scene.camera.position = {3, 700, 5};
  scene.lights.push_back(atmosphere(0.1, 400));
  scene.lights.push_back({});
  EXPECT_EQ(light_with_air(scene.lights), 0);
  EXPECT_NEAR(lights_at_camera(scene)[0].altitude, 7400, 40);
  scene.camera.position.y = -1000; // below the ground
  EXPECT_EQ(lights_at_camera(scene)[0].altitude, 1);
  scene.lights[0].metres_per_unit.reset();
  EXPECT_EQ(light_with_air(scene.lights), -1);
  EXPECT_EQ(lights_at_camera(scene)[0].altitude, 400);
}

} // namespace
} // namespace vdbeam
