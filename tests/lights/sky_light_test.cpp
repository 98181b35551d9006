#include "lights/light_test_scene.h"

namespace vdbeam {
namespace {

using namespace test;

LightSettings sky() {
  LightSettings settings;
  settings.type = LightType::sky;
  settings.zenith = {0.2f, 0.4f, 1};
  settings.horizon = {2, 1.5f, 1};
  settings.ground = {0.1f, 0.2f, 0.3f};
  return settings;
}

// Integral of a function of the elevation's sine over the sphere, by midpoints.
template <class F>
double over_sphere(F value) {
  constexpr int steps = 100000;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum += value((2.0 * i + 1) / steps - 1);
  return sum * 4 * std::numbers::pi / steps;
}

Vec3f at_elevation(double sine) {
  return Vec3f(Vec3d(std::sqrt(1 - sine * sine), sine, 0));
}

TEST(SkyLight, RunsFromHorizonToZenithAndGround) {
  const MadeLight made(sky(), region_of({cube({}, 1)}));
  const auto at = [&](const Vec3f& d) { return escaped_radiance(*made.light, normalize(d)); };
  EXPECT_EQ(at({0, 1, 0}), sky().zenith);
  EXPECT_EQ(at({0, -1, 0}), sky().ground);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(at({1, 0, 0})[c], sky().horizon[c], 1e-6f);
    EXPECT_NEAR(at({0, 0, -1})[c], sky().horizon[c], 1e-6f);
  }
  EXPECT_EQ(at({1, -0.5f, 0}), sky().ground);
  for (double y = 0.02; y < 0.9; y += 0.02) // ever darker and bluer
    EXPECT_LT(at(at_elevation(y)).x, at(at_elevation(y - 0.02)).x);
  LightSettings dim = sky();
  dim.radiance = {0.5f, 0.25f, 0};
  const MadeLight half(dim, region_of({cube({}, 1)}));
  EXPECT_EQ(escaped_radiance(*half.light, {0, 1, 0}), Rgb(0.1f, 0.1f, 0));
}

TEST(SkyLight, SamplesWhatItShows) {
  const MadeLight made(sky(), region_of({cube({}, 1)}));
  EXPECT_FALSE(made.light->is_delta());
  EXPECT_NEAR(over_sphere([&](double y) -> double {
                return made.light->incident_pdf({}, at_elevation(y));
              }),
              1, 1e-4);
  Average irradiance; // on a floor that faces upwards
  Rng rng({}, RngStage::test, 0);
  for (int i = 0; i < 40000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    ASSERT_GT(s.pdf, 0);
    EXPECT_NEAR(length(s.wi), 1, 1e-5f);
    irradiance.add(static_cast<double>(s.value.x * std::max(0.0f, s.wi.y)));
    const Rgb shown = escaped_radiance(*made.light, s.wi);
    EXPECT_NEAR(s.value.x * s.pdf, shown.x, 1e-3f * shown.x);
  }
  expect_mean(irradiance, over_sphere([&](double y) {
                return static_cast<double>(escaped_radiance(*made.light, at_elevation(y)).x) *
                       std::max(0.0, y);
              }));
}

TEST(SkyLight, PhotonsBringItsFluenceIntoTheBox) {
  const Parallelepiped box = skew_box();
  const MadeLight made(sky(), region_of({box}));
  const Emission emission = emit_many(made, 60000, box);
  expect_mean(emission.fluence, over_sphere([&](double y) -> double {
                return escaped_radiance(*made.light, at_elevation(y)).x;
              }));
  EXPECT_NEAR(made.light->power().x, emission.flux.mean(), 0.05 * emission.flux.mean());
}

TEST(SkyLight, OfOneColourIsTheConstantEnvironment) {
  LightSettings even = sky();
  even.zenith = even.horizon = even.ground = Rgb(2);
  const MadeLight made(even, region_of({cube({}, 1)}));
  EXPECT_NEAR(made.light->power().x, 2 * std::numbers::pi * 6, 0.05 * 2 * std::numbers::pi * 6);
  EXPECT_NEAR(made.light->incident_pdf({}, {0, 1, 0}), 1 / (4 * std::numbers::pi), 1e-6);
}

TEST(SkyLight, MayBeBlack) {
  LightSettings black = sky();
  black.radiance = Rgb(0);
  const MadeLight made(black, region_of({cube({}, 1)}));
  EXPECT_EQ(made.light->power(), Rgb());
  EXPECT_EQ(made.light->sample_incident({}, 0.5f, 0.5f).value, Rgb());
  Rng rng({}, RngStage::test, 0);
  EXPECT_EQ(made.light->emit(rng).flux, Rgb());
}

} // namespace
} // namespace vdbeam
