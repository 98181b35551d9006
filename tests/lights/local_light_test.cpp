#include "lights/light_test_scene.h"
#include "lights/local_aim.h"

namespace vdbeam {
namespace {

using namespace test;

LightSettings point(const Vec3d& position) {
  LightSettings settings;
  settings.type = LightType::point;
  settings.position = position;
  settings.intensity = {5, 3, 2};
  return settings;
}

LightSettings spot(const Vec3d& position, const Vec3d& direction, double angle, double falloff) {
  LightSettings settings = point(position);
  settings.type = LightType::spot;
  settings.direction = direction;
  settings.cone_angle = angle;
  settings.cone_falloff = falloff;
  return settings;
}

// Mean over a box of intensity / distance^2 (times a spot's share), by a fine grid of points.
double mean_fluence(const MadeLight& made, const Parallelepiped& box) {
  constexpr int n = 60;
  double sum = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const auto at = [](int k) { return (static_cast<float>(k) + 0.5f) / n; };
    const Vec3f p = box.corner + box.edges[0] * at(i % n) + box.edges[1] * at(i / n % n) +
                    box.edges[2] * at(i / n / n);
    sum += static_cast<double>(made.light->sample_incident(p, 0, 0).value.x);
  }
  return sum / (n * n * n);
}

// The same for a light inside the box: intensity times the way to the wall, over all directions,
// since a grid of points would miss the pole at the light.
double mean_fluence_around(const MadeLight& made, const Vec3f& light, const Parallelepiped& box) {
  constexpr int n = 700;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3f d =
          sample_sphere((static_cast<float>(i) + 0.5f) / n, (static_cast<float>(j) + 0.5f) / n);
      const double intensity = made.light->sample_incident(light + d, 0, 0).value.x;
      sum += intensity * chord(box, {light, d});
    }
  return sum * 4 * std::numbers::pi / (n * n) / volume_of(box);
}

TEST(PointLight, IrradianceFallsWithTheSquare) {
  const MadeLight made(point({0, 4, 0}), region_of({cube({}, 1)}));
  const IncidentSample s = made.light->sample_incident({0, 2, 0}, 0.5f, 0.5f);
  EXPECT_EQ(s.wi, Vec3f(0, 1, 0));
  EXPECT_FLOAT_EQ(s.distance, 2);
  EXPECT_FLOAT_EQ(s.value.x, 5 / 4.0f);
  EXPECT_FLOAT_EQ(s.value.z, 2 / 4.0f);
  EXPECT_TRUE(made.light->is_delta());
}

// Render space of scale 1/8: the same point of the world receives the same irradiance.
TEST(PointLight, IrradianceIsTheSameInEveryRenderSpace) {
  const OccupiedRegion region = region_of({cube({}, 1)});
  const MadeLight world(point({0, 40, 8}), region), scaled(point({0, 40, 8}), region, 0.125);
  const float a = world.light->sample_incident({8, 16, 0}, 0, 0).value.y;
  const float b = scaled.light->sample_incident({1, 2, 0}, 0, 0).value.y;
  EXPECT_FLOAT_EQ(a, b);
  EXPECT_FLOAT_EQ(a, 3.0f / (64 + 576 + 64));
}

TEST(PointLight, PhotonsGiveTheFluenceFromOutsideAndInside) {
  for (const Vec3d& position : {Vec3d{0, 3, 0.5}, Vec3d{0.6, -0.7, 0.9}, Vec3d{0.1, 0.2, -0.1}}) {
    const Parallelepiped probe = cube({0.1f, -0.1f, 0.2f}, 0.7f);
    const MadeLight made(point(position), region_of({cube({}, 1), skew_box()}));
    const Emission emission = emit_many(made, 60000, probe, 1);
    const double expected = contains(probe, position)
                                ? mean_fluence_around(made, Vec3f(position), probe)
                                : mean_fluence(made, probe);
    EXPECT_NEAR(emission.fluence.mean(), expected,
                4.5 * emission.fluence.error() + 3e-3 * expected);
    EXPECT_LT(emission.fluence.error(), 0.03 * expected);
  }
}

TEST(PointLight, ConeIsTightAndPowerIsItsFlux) {
  const Parallelepiped box = cube({}, 1);
  const MadeLight made(point({0, 10, 0}), region_of({box}));
  const Emission emission = emit_many(made, 40000, box, 2);
  EXPECT_GT(emission.flux.mean(), 0.4 * made.light->power().x);
  // The solid angle of a square of side 1 seen from distance 9.5: 4 asin(a^2 / (a^2 + d^2)).
  expect_mean(emission.flux, 5 * 4 * std::asin(0.25 / (0.25 + 9.5 * 9.5)));
}

// Far away the photons still enter at exact places: their origins lie near the region.
TEST(PointLight, FarLightKeepsPrecision) {
  LightSettings settings = point({3e6, 1e6, -2e6});
  settings.intensity = Rgb(1e13f);
  const Parallelepiped box = cube({}, 1), probe = cube({0.2f, -0.3f, 0.1f}, 0.1f);
  const MadeLight made(settings, region_of({box}));
  const double irradiance = 1e13 / (9e12 + 1e12 + 4e12);
  EXPECT_NEAR(made.light->sample_incident({}, 0, 0).value.x, irradiance, 1e-5);
  expect_mean(emit_many(made, 200000, probe, 3).fluence, irradiance);
  for (std::uint64_t i = 0; i < 100; ++i) {
    Rng rng({}, RngStage::test, i);
    EXPECT_LT(length(made.light->emit(rng).ray.origin), 1.0f);
  }
}

TEST(PointLight, EveryPhotonHasTheSameFlux) {
  const MadeLight made(point({0, 0.1, 0}), region_of({cube({}, 1)}));
  for (std::uint64_t i = 0; i < 100; ++i) {
    Rng rng({}, RngStage::test, i);
    EXPECT_FLOAT_EQ(made.light->emit(rng).flux.x, 4 * pi * 5);
  }
}

TEST(PointLight, ExtremesStayFinite) {
  for (const float intensity : {1e-20f, 1e20f}) {
    LightSettings settings = point({0.5, 0.5, 0.5});
    settings.intensity = Rgb(intensity);
    const MadeLight made(settings, region_of({cube({}, 1)}));
    for (const Vec3f& p : {Vec3f(0.5f), Vec3f{0.5f, 0.5f, 0.5000001f}, Vec3f(0)}) {
      const IncidentSample s = made.light->sample_incident(p, 0, 0);
      EXPECT_TRUE(std::isfinite(s.value.x));
      EXPECT_NEAR(length(s.wi), 1, 1e-6);
    }
    EXPECT_GT(made.light->power().x, intensity);
  }
}

TEST(PointLight, ConeHoldsEveryBoxAndLittleElse) {
  const std::vector<Parallelepiped> boxes{cube({0.4f, 0, 0}, 0.5f), skew_box()};
  const OccupiedRegion region = region_of(boxes);
  for (const Vec3d& position : {Vec3d{0, 2, 0}, Vec3d{0.9, -0.8, 1}, Vec3d{4e5, 1e5, -7e5}}) {
    const Cone cone = cone_towards(position, region);
    double widest = 0;
    for (const Parallelepiped& box : boxes)
      for (int corner = 0; corner < 8; ++corner) {
        Vec3d to = Vec3d(box.corner) - position;
        for (int i = 0; i < 3; ++i)
          if (corner >> i & 1)
            to += Vec3d(box.edges[i]);
        const Vec3d chord = normalize(to) - cone.axis;
        widest = std::max(widest, dot(chord, chord) / 2);
      }
    EXPECT_GE(cone.one_minus_cos, widest);
    EXPECT_LE(cone.one_minus_cos, widest * 1.001);
  }
  EXPECT_EQ(cone_towards({0.4, 0, 0}, region).one_minus_cos, 2); // inside: all around
}

TEST(SpotLight, FallsSmoothlyFromFullToNothing) {
  const MadeLight made(spot({0, 0, 0}, {0, 0, 1}, 30, 10), region_of({cube({0, 0, 3}, 1)}));
  const auto irradiance = [&](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return made.light
        ->sample_incident({static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))}, 0,
                          0)
        .value.x;
  };
  EXPECT_FLOAT_EQ(irradiance(0), 5);
  EXPECT_FLOAT_EQ(irradiance(19.9), 5);
  EXPECT_EQ(irradiance(30.1), 0);
  EXPECT_EQ(irradiance(150), 0);
  float last = 5;
  for (double degrees = 20; degrees < 30.2; degrees += 0.1) {
    EXPECT_LE(irradiance(degrees), last + 1e-5f);
    EXPECT_GT(irradiance(degrees), last - 0.2f); // no step
    last = irradiance(degrees);
  }
  EXPECT_GT(irradiance(25), 1);
  EXPECT_LT(irradiance(25), 4);
}

TEST(SpotLight, SharpEdgeIsAllowed) {
  const MadeLight made(spot({0, 0, 0}, {0, 0, 1}, 45, 0), region_of({cube({0, 0, 3}, 1)}));
  EXPECT_FLOAT_EQ(made.light->sample_incident({0.999f, 0, 1}, 0, 0).value.x, 5 / 1.998001f);
  EXPECT_EQ(made.light->sample_incident({1.001f, 0, 1}, 0, 0).value.x, 0);
}

/// Outside of the part that a spot light says it shines on there is nothing of it, and the part is
/// no longer than it must be.
TEST(SpotLight, ShinesOnAPartOfARay) {
  for (const double angle : {0.5, 12.0, 60.0, 89.0, 120.0}) {
    const MadeLight made(spot({0.2, 0.1, -1}, {0.3, -0.2, 1}, angle, 0), region_of({cube({}, 3)}));
    for (std::uint64_t i = 0; i < 400; ++i) {
      Rng rng({}, RngStage::test, i);
      const auto number = [&] { return 2 * rng.uniform() - 1; };
      const Vec3f origin{number(), number(), number()}, to{number(), number(), number()};
      const Segment ray{{origin, normalize(to)}, 0, 2};
      const Segment part = made.light->lit_part(ray);
      int lit = 0;
      constexpr int steps = 500;
      for (int k = 0; k < steps; ++k) {
        const float t = (static_cast<float>(k) + 0.5f) * 2 / steps;
        const bool shines = made.light->sample_incident(ray.ray.at(t), 0, 0).value.x > 0;
        lit += shines;
        EXPECT_TRUE(!shines || (part.t_begin - 1e-4f <= t && t <= part.t_end + 1e-4f))
            << angle << " " << i;
      }
      const float expected = angle > 90 ? 2 : static_cast<float>(lit) * 2 / steps;
      EXPECT_NEAR(std::max(0.0f, part.t_end - part.t_begin), expected, 0.01f) << angle << " " << i;
    }
  }
}

TEST(SpotLight, PhotonsGiveTheFluence) {
  const Parallelepiped box = cube({}, 1);
  // A narrow beam through the box, one wider than the box, one that starts inside, one that grazes.
  for (const LightSettings& settings :
       {spot({0, 3, 0}, {0.02, -1, 0}, 6, 3), spot({0, 3, 0}, {0.1, -1, 0}, 60, 30),
        spot({0.1, 0.2, 0.1}, {0, -1, 0.3}, 40, 40), spot({0, 3, 0}, {0.3, -1, 0}, 15, 5)}) {
    const MadeLight made(settings, region_of({box}));
    const Emission emission = emit_many(made, 60000, box, 4);
    const bool inside = contains(box, settings.position);
    const double expected =
        inside ? mean_fluence_around(made, Vec3f(settings.position), box) : mean_fluence(made, box);
    EXPECT_NEAR(emission.fluence.mean(), expected,
                4.5 * emission.fluence.error() + 5e-3 * expected);
    EXPECT_LT(emission.fluence.error(), 0.03 * expected);
  }
}

TEST(SpotLight, PowerIsTheMeanFlux) {
  const MadeLight made(spot({0, 3, 0}, {0, -1, 0}, 12, 6), region_of({cube({}, 1)}));
  Average flux;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    Rng rng({}, RngStage::test, i);
    flux.add(static_cast<double>(made.light->emit(rng).flux.x));
  }
  EXPECT_NEAR(made.light->power().x, flux.mean(), 0.03 * flux.mean());
}

} // namespace
} // namespace vdbeam
