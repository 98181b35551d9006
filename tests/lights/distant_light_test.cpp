#include "lights/light_test_scene.h"
#include "vdbeam/error.h"

namespace vdbeam {
namespace {

using namespace test;

LightSettings sun(const Vec3d& direction, double radius = 0) {
  LightSettings settings;
  settings.type = LightType::distant;
  settings.direction = direction;
  settings.irradiance = {3, 2, 1};
  settings.angular_radius = radius;
  return settings;
}

double projected_area(const Parallelepiped& box, const Vec3f& direction) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    sum +=
        std::abs(static_cast<double>(dot(cross(box.edges[i], box.edges[(i + 1) % 3]), direction)));
  return sum;
}

TEST(DistantLight, DeltaGivesItsIrradianceFromOneDirection) {
  const MadeLight made(sun({0, -2, 0}), region_of({cube({}, 1)}));
  const IncidentSample s = made.light->sample_incident({0.3f, 0.1f, 0}, 0.2f, 0.9f);
  EXPECT_EQ(s.wi, Vec3f(0, 1, 0));
  EXPECT_EQ(s.distance, infinity);
  EXPECT_EQ(s.value, Rgb(3, 2, 1));
  EXPECT_EQ(s.pdf, 0);
  EXPECT_TRUE(made.light->is_delta());
  EXPECT_EQ(escaped_radiance(*made.light, {0, 1, 0}), Rgb());
}

TEST(DistantLight, RefusesNoDirection) {
  EXPECT_THROW(MadeLight(sun({0, 0, 0}), region_of({cube({}, 1)})), InputError);
}

// Irradiance on the plane that faces the light and on a tilted one, for narrow and wide discs.
TEST(DistantLight, DiscGivesItsIrradiance) {
  for (const double radius : {1e-4, 0.27, 5.0, 40.0, 90.0}) {
    const MadeLight made(sun({0.3, -0.8, 0.2}, radius), region_of({cube({}, 1)}));
    const Vec3f facing = normalize(Vec3f{-0.3f, 0.8f, -0.2f});
    Average irradiance;
    Rng rng({}, RngStage::test, 5);
    for (int i = 0; i < 20000; ++i) {
      const float u = rng.uniform(), v = rng.uniform();
      const IncidentSample s = made.light->sample_incident({}, u, v);
      irradiance.add(static_cast<double>(s.value.x * dot(s.wi, facing)));
      if (radius > 0.01) {
        EXPECT_FLOAT_EQ(made.light->incident_pdf({}, s.wi * 0.9999999f), s.pdf);
        EXPECT_NEAR(escaped_radiance(*made.light, s.wi).y * (1 / s.pdf), s.value.y,
                    1e-4f * s.value.y);
      }
    }
    expect_mean(irradiance, 3);
    EXPECT_FALSE(made.light->is_delta());
  }
}

TEST(DistantLight, DiscShowsUniformRadianceOnlyInside) {
  const MadeLight made(sun({0, 0, -1}, 10), region_of({cube({}, 1)}));
  const double radius = 10 * std::numbers::pi / 180;
  const auto radiance_at = [&](double angle) {
    return escaped_radiance(
        *made.light, {0, static_cast<float>(std::sin(angle)), static_cast<float>(std::cos(angle))});
  };
  const double expected = 3 / (std::numbers::pi * std::sin(radius) * std::sin(radius));
  EXPECT_NEAR(radiance_at(0).x, expected, 1e-5 * expected);
  EXPECT_NEAR(radiance_at(radius * 0.999).x, expected, 1e-5 * expected);
  EXPECT_EQ(radiance_at(radius * 1.001), Rgb());
  EXPECT_EQ(radiance_at(3), Rgb());
}

TEST(DistantLight, PhotonsCarryIrradianceTimesSilhouette) {
  const Vec3d direction{0.4, -0.7, 0.3};
  const Vec3f unit(normalize(direction));
  for (const Parallelepiped& box : {cube({0.2f, 0.1f, -0.3f}, 0.8f), skew_box()})
    for (const double radius : {0.0, 0.27}) {
      const MadeLight made(sun(direction, radius), region_of({box}));
      const Emission emission = emit_many(made, 40000, box, 1);
      // The disc's irradiance on a plane tilted from the axis is linear in the tilt's cosine.
      expect_mean(emission.flux, 3 * projected_area(box, unit));
      // Fluence of a disc: radiance * solid angle = 2 E / (1 + cos radius).
      expect_mean(emission.fluence, 6 / (1 + std::cos(radius * std::numbers::pi / 180)));
      EXPECT_EQ(emission.outside, 0);
      // The mask wastes little and the power says what the photons carry.
      EXPECT_LT(made.light->power().x, 1.06 * emission.flux.mean());
      EXPECT_GT(made.light->power().x, 0.999 * emission.flux.mean());
    }
}

// Over all photons of a disc, hit or miss, the mask's plane receives the irradiance.
TEST(DistantLight, DiscPhotonsCarryTheMasksPower) {
  const MadeLight made(sun({0.4, -0.7, 0.3}, 5.5), region_of({skew_box()}));
  Average flux;
  for (std::uint64_t i = 0; i < 10000; ++i) {
    Rng rng({}, RngStage::test, i);
    flux.add(static_cast<double>(made.light->emit(rng).flux.x));
  }
  EXPECT_LT(flux.error(), 3e-5 * flux.mean());
  expect_mean(flux, made.light->power().x);
}

TEST(DistantLight, WideDiscPhotonsGiveTheFluence) {
  const Parallelepiped box = skew_box();
  for (const double radius : {5.0, 30.0, 90.0}) {
    const MadeLight made(sun({0.4, -0.7, 0.3}, radius), region_of({box, cube({0, 0, 0.1f}, 0.3f)}));
    const Emission emission = emit_many(made, 40000, box, 2);
    expect_mean(emission.fluence, 6 / (1 + std::cos(radius * std::numbers::pi / 180)));
    EXPECT_EQ(emission.outside, 0);
  }
}

// Two overlapping boxes: a line through both counts once.
TEST(DistantLight, OverlappingBoxesCountOnce) {
  const Parallelepiped a = cube({0, 0, 0}, 1), b = cube({0.5f, 0, 0}, 1);
  for (const double radius : {0.0, 20.0}) {
    const MadeLight made(sun({0, 0, 1}, radius), region_of({a, b}));
    const Emission emission = emit_many(made, 40000, b, 3);
    if (radius == 0)
      expect_mean(emission.flux, 3 * 1.5);
    expect_mean(emission.fluence, 6 / (1 + std::cos(radius * std::numbers::pi / 180)));
  }
}

// Cells that fill two corners of the box: the photons go there, and nowhere else.
TEST(DistantLight, CellsNarrowTheAim) {
  OccupiedRegion region = region_of({cube({}, 1)});
  region.cells = {cube({-0.4f, -0.4f, 0.4f}, 0.2f), cube({0.4f, 0.4f, -0.4f}, 0.2f),
                  cube({0.4f, 0.4f, 0.3f}, 0.2f)};
  for (const double radius : {0.0, 0.27}) {
    const MadeLight made(sun({0, 0, 1}, radius), region);
    for (const Parallelepiped& cell : region.cells)
      expect_mean(emit_many(made, 40000, cell, 4).fluence,
                  6 / (1 + std::cos(radius * std::numbers::pi / 180)));
    EXPECT_NEAR(made.light->power().x, 3 * 0.08, 3 * 0.08 * 0.08);
    // Photons start before the first cell on their way, not at the region's edge.
    for (std::uint64_t i = 0; i < 1000; ++i) {
      Rng rng({}, RngStage::test, i);
      const EmittedPhoton photon = made.light->emit(rng);
      const float expected = photon.ray.origin.x < 0 ? 0.3f : -0.5f;
      EXPECT_NEAR(photon.ray.origin.z, expected, 0.01f);
      EXPECT_LT(photon.ray.origin.z, expected + 1e-5f);
    }
  }
}

// Each cell of a fine rotated grid receives its share: no cell falls between the mask's pixels.
TEST(DistantLight, MaskCoversEveryCell) {
  OccupiedRegion region = region_of({make_box({}, {0.6f, 0.8f, 0}, {-0.8f, 0.6f, 0}, {0, 0, 1})});
  const Parallelepiped box = region.boxes[0];
  constexpr int n = 12;
  for (int i = 0; i < n * n * n; ++i) {
    const Vec3f index(static_cast<float>(i % n), static_cast<float>(i / n % n),
                      static_cast<float>(i / n / n));
    if (length(index - Vec3f(5.5f)) < 5)
      region.cells.push_back(make_box(box.corner + box.edges[0] * (index.x / n) +
                                          box.edges[1] * (index.y / n) +
                                          box.edges[2] * (index.z / n),
                                      box.edges[0] / n, box.edges[1] / n, box.edges[2] / n));
  }
  const MadeLight made(sun({0.3, -0.5, 0.8}), region);
  for (std::size_t i = 0; i < region.cells.size(); i += 97)
    expect_mean(emit_many(made, 60000, region.cells[i], i).fluence, 3, 5);
}

TEST(DistantLight, EmptyRegionHasNoPhotons) {
  for (const double radius : {0.0, 0.27, 30.0}) {
    const MadeLight made(sun({0, -1, 0}, radius), OccupiedRegion{});
    Rng rng({}, RngStage::test, 0);
    EXPECT_EQ(made.light->emit(rng).flux, Rgb());
    EXPECT_EQ(made.light->power(), Rgb());
  }
}

TEST(DistantLight, ExtremeIrradianceStaysFinite) {
  for (const float e : {1e-20f, 1e20f})
    for (const double radius : {0.0, 1e-9, 0.27, 30.0}) {
      LightSettings settings = sun({1, -1, 1}, radius);
      settings.irradiance = Rgb(e);
      const MadeLight made(settings, region_of({cube({}, 1)}));
      Rng rng({}, RngStage::test, 0);
      const float flux = made.light->emit(rng).flux.x;
      EXPECT_GT(flux, 0.5f * e);
      EXPECT_LT(flux, 10 * e);
      EXPECT_NEAR(made.light->sample_incident({}, 0.5f, 0.5f).value.x, e, e);
      const Vec3f back = normalize(Vec3f{-1, 1, -1});
      EXPECT_TRUE(std::isfinite(escaped_radiance(*made.light, back).x));
    }
}

} // namespace
} // namespace vdbeam
