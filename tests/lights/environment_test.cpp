#include "lights/environment_image.h"
#include "lights/light_test_scene.h"
#include "support/chi_squared.h"
#include "vdbeam/error.h"

namespace vdbeam {
namespace {

using namespace test;

LightSettings sky(const Rgb& radiance) {
  LightSettings settings;
  settings.type = LightType::environment;
  settings.radiance = radiance;
  return settings;
}

template <class F>
Image lat_long(int width, int height, F value) {
  Image image;
  image.width = width;
  image.height = height;
  for (const char* name : {"R", "G", "B"}) {
    ImageChannel channel{name, {}, false};
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        channel.data.push_back(value(x, y));
    image.channels.push_back(channel);
  }
  return image;
}

struct ImageLight {
  OccupiedRegion region;
  RenderSpace space;
  std::unique_ptr<Light> light;

  ImageLight(const Image& image, const LightSettings& settings, OccupiedRegion region_ = {},
             const Vec3d& up = {0, 1, 0})
      : region(std::move(region_)),
        light(make_environment_image(image, "sky.exr", settings, LightContext{up, space, region})) {
  }
};

// A dim gradient with a small, very bright sun.
Image sunny_sky(int width = 64, int height = 32) {
  return lat_long(width, height, [=](int x, int y) {
    const bool sun = x == width / 5 && y == height / 4;
    return sun ? 5000.0f : 0.2f + static_cast<float>(y) / static_cast<float>(height);
  });
}

TEST(ConstantEnvironment, ShowsAndSamplesItsRadiance) {
  const MadeLight made(sky({2, 1, 0.5f}), region_of({cube({}, 1)}));
  EXPECT_EQ(escaped_radiance(*made.light, {0, 1, 0}), Rgb(2, 1, 0.5f));
  EXPECT_FALSE(made.light->is_delta());
  Average irradiance; // on a plane: pi L
  Rng rng({}, RngStage::test, 0);
  for (int i = 0; i < 40000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    irradiance.add(static_cast<double>(s.value.x * std::max(0.0f, s.wi.y)));
    EXPECT_FLOAT_EQ(s.value.y, 1 / s.pdf);
    EXPECT_EQ(s.pdf, made.light->incident_pdf({}, s.wi));
  }
  expect_mean(irradiance, 2 * std::numbers::pi);
}

TEST(ConstantEnvironment, PhotonsCarryPiTimesSurfaceAndUniformFluence) {
  const Parallelepiped box = make_box({-0.5f, -0.2f, -0.3f}, {1, 0, 0}, {0, 0.4f, 0}, {0, 0, 0.6f});
  const MadeLight made(sky(Rgb(2)), region_of({box}));
  const Emission emission = emit_many(made, 40000, box, 1);
  const double surface = 2 * (0.4 + 0.6 + 0.24);
  expect_mean(emission.flux, std::numbers::pi * 2 * surface);
  expect_mean(emission.fluence, 4 * std::numbers::pi * 2);
  EXPECT_NEAR(made.light->power().x, std::numbers::pi * 2 * surface, 1e-4);
}

TEST(ConstantEnvironment, OverlappingBoxesAreNotCountedTwice) {
  const std::vector<Parallelepiped> boxes{cube({}, 1), skew_box(), cube({0.4f, 0.3f, 0}, 0.8f)};
  const MadeLight made(sky(Rgb(1)), region_of(boxes));
  for (const Parallelepiped& box : boxes)
    expect_mean(emit_many(made, 60000, box, 2).fluence, 4 * std::numbers::pi);
}

TEST(ConstantEnvironment, TwoBoxesOfTheSamePlaceAreOne) {
  const MadeLight made(sky(Rgb(1)), region_of({cube({}, 1), cube({}, 1)}));
  expect_mean(emit_many(made, 40000, cube({}, 1), 3).flux, 6 * std::numbers::pi);
}

TEST(EnvironmentImage, LaysOutDirectionsAsOpenExrDoes) {
  // A pixel's brightness is its column; rows differ by 100.
  const Image image = lat_long(8, 4, [](int x, int y) { return static_cast<float>(x + 100 * y); });
  const ImageLight made(image, sky(Rgb(1)));
  const auto at = [&](const Vec3f& d) { return escaped_radiance(*made.light, normalize(d)).x; };
  EXPECT_NEAR(at({0, 1, 0}), 3.5f, 4.1f);         // top row
  EXPECT_NEAR(at({0, -1, 0}), 303.5f, 4.1f);      // bottom row
  EXPECT_NEAR(at({0, 0, 1}), 150 + 3.5f, 1e-3f);  // the middle
  EXPECT_NEAR(at({1, 0, 0}), 150 + 1.5f, 1e-3f);  // a quarter from the left
  EXPECT_NEAR(at({-1, 0, 0}), 150 + 5.5f, 1e-3f); // three quarters
  EXPECT_NEAR(at({0, 0, -1}), 150 + 3.5f, 1e-3f); // the seam: half of 0 and half of 7
}

TEST(EnvironmentImage, RotationTurnsAboutUp) {
  const Image image = lat_long(8, 4, [](int x, int y) { return static_cast<float>(x + 100 * y); });
  LightSettings turned = sky(Rgb(1));
  turned.rotation = 90; // +z goes to +x, seen from above counter-clockwise
  const ImageLight y_up(image, turned), z_up(image, sky(Rgb(1)), {}, {0, 0, 1}),
      upside_down(image, sky(Rgb(1)), {}, {0, -1, 0});
  EXPECT_NEAR(escaped_radiance(*y_up.light, {1, 0, 0}).x, 153.5f, 1e-3f);
  EXPECT_NEAR(escaped_radiance(*y_up.light, {0, 0, -1}).x, 151.5f, 1e-3f);
  EXPECT_NEAR(escaped_radiance(*z_up.light, {0, -1, 0}).x, 153.5f, 1e-3f);
  EXPECT_NEAR(escaped_radiance(*z_up.light, {1, 0, 0}).x, 151.5f, 1e-3f);
  EXPECT_LT(escaped_radiance(*z_up.light, {0, 0, 1}).x, 10);
  EXPECT_LT(escaped_radiance(*upside_down.light, {0, -1, 0}).x, 10);
}

TEST(EnvironmentImage, ConstantImageIsTheConstantEnvironment) {
  const Parallelepiped box = skew_box();
  const ImageLight made(lat_long(16, 8, [](int, int) { return 0.5f; }), sky({2, 4, 6}),
                        region_of({box}));
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 2000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    EXPECT_NEAR(s.pdf, 1 / (4 * pi), 1e-6f);
    EXPECT_NEAR(s.value.y, 4 * pi * 2, 2e-4f);
    EXPECT_NEAR(escaped_radiance(*made.light, s.wi).z, 3, 1e-5f);
  }
  Average fluence;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    Rng photon_rng({}, RngStage::test, i);
    const EmittedPhoton photon = made.light->emit(photon_rng);
    fluence.add(static_cast<double>(photon.flux.x) * chord(box, photon.ray) / volume_of(box));
  }
  expect_mean(fluence, 4 * std::numbers::pi);
}

// Integrals over the sphere, by midpoints on a grid that resolves the pixels.
template <class F>
double over_sphere(F f) {
  constexpr int rows = 1600, columns = 1600;
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double cosine = 1 - 2 * (i + 0.5) / rows,
                   phi = 2 * std::numbers::pi * (j + 0.5) / columns;
      const double sine = std::sqrt(1 - cosine * cosine);
      sum += f(Vec3f(Vec3d{sine * std::cos(phi), cosine, sine * std::sin(phi)}));
    }
  return sum * 4 * std::numbers::pi / (static_cast<double>(rows) * columns);
}

TEST(EnvironmentImage, DensityIntegratesToOneAndCoversAllLight) {
  for (const auto& [width, height] : {std::pair{64, 32}, std::pair{7, 5}, std::pair{1, 1}}) {
    const Image image =
        width > 10
            ? sunny_sky(width, height)
            : lat_long(width, height, [](int x, int y) { return x == 2 && y == 3 ? 1.0f : 0.0f; });
    const ImageLight made(width == 1 ? lat_long(1, 1, [](int, int) { return 1.0f; }) : image,
                          sky(Rgb(1)));
    const double total = over_sphere([&](const Vec3f& d) -> double {
      const float pdf = made.light->incident_pdf({}, d);
      EXPECT_TRUE(pdf > 0 || escaped_radiance(*made.light, d).x == 0);
      return static_cast<double>(pdf);
    });
    EXPECT_NEAR(total, 1, 2e-3) << width;
  }
}

TEST(EnvironmentImage, SamplesFollowTheDensity) {
  const ImageLight made(sunny_sky(32, 16), sky(Rgb(1)));
  constexpr int rows = 12, columns = 24, samples = 100000;
  std::vector<double> counts(rows * columns, 0.0), expected(rows * columns, 0.0);
  const auto bin = [](const Vec3f& d) {
    const double turn = std::atan2(d.z, d.x) / (2 * std::numbers::pi) + 0.5;
    const int row = std::min(rows - 1, static_cast<int>((1 - d.y) / 2 * rows));
    return row * columns + std::min(columns - 1, static_cast<int>(turn * columns));
  };
  over_sphere([&](const Vec3f& d) {
    const double mass = made.light->incident_pdf({}, d);
    expected[bin(d)] += mass;
    return 0.0;
  });
  double total = 0;
  for (const double e : expected)
    total += e;
  for (double& e : expected)
    e *= samples / total;
  int across_edges = 0;
  Rng rng({}, RngStage::test, 7);
  for (int i = 0; i < samples; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    // Where rounding takes the direction across a pixel's edge, the density is the neighbour's.
    across_edges += std::abs(s.pdf - made.light->incident_pdf({}, s.wi)) > 1e-3f * s.pdf;
    counts[bin(s.wi)] += 1;
  }
  EXPECT_LT(across_edges, 10); // 48 edges of 1e-6 in u + v: 5 of 100,000 at most
  EXPECT_GT(chi_squared_test(counts, expected), 1e-3);
}

TEST(EnvironmentImage, SampledIrradianceIsTheIntegral) {
  const ImageLight made(sunny_sky(), sky(Rgb(1)));
  const Vec3f normal = normalize(Vec3f{0.2f, 1, -0.3f});
  const double expected = over_sphere([&](const Vec3f& d) -> double {
    return static_cast<double>(escaped_radiance(*made.light, d).x * std::max(0.0f, dot(d, normal)));
  });
  Average irradiance;
  Rng rng({}, RngStage::test, 3);
  for (int i = 0; i < 80000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    irradiance.add(static_cast<double>(s.value.x * std::max(0.0f, dot(s.wi, normal))));
    EXPECT_NEAR(escaped_radiance(*made.light, s.wi).x, s.value.x * s.pdf,
                2e-3f * s.value.x * s.pdf);
  }
  EXPECT_NEAR(irradiance.mean(), expected, 4.5 * irradiance.error() + 2e-3 * expected);
  EXPECT_LT(irradiance.error(), 5e-3 * expected);
}

TEST(EnvironmentImage, PhotonsGiveTheFluence) {
  const std::vector<Parallelepiped> boxes{cube({}, 1), skew_box()};
  const ImageLight made(sunny_sky(), sky(Rgb(1)), region_of(boxes));
  const double expected =
      over_sphere([&](const Vec3f& d) -> double { return escaped_radiance(*made.light, d).x; });
  for (const Parallelepiped& box : boxes) {
    Average fluence, flux;
    for (std::uint64_t i = 0; i < 40000; ++i) {
      Rng rng({}, RngStage::test, i);
      const EmittedPhoton photon = made.light->emit(rng);
      fluence.add(static_cast<double>(photon.flux.x) * chord(box, photon.ray) / volume_of(box));
      flux.add(static_cast<double>(photon.flux.x));
    }
    EXPECT_NEAR(fluence.mean(), expected, 4.5 * fluence.error() + 2e-3 * expected);
    EXPECT_NEAR(made.light->power().x, flux.mean(), 0.03 * flux.mean());
  }
}

// Larger than the table: pixels share blocks, and the last block is narrower.
TEST(EnvironmentImage, LargeImagesShareBlocks) {
  const ImageLight made(sunny_sky(2050, 1027), sky(Rgb(1)));
  Average total;
  Rng rng({}, RngStage::test, 4);
  for (int i = 0; i < 20000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const IncidentSample s = made.light->sample_incident({}, u, v);
    EXPECT_NEAR(s.pdf, made.light->incident_pdf({}, s.wi), 1e-2f * s.pdf);
    total.add(static_cast<double>(s.value.x));
  }
  double expected = 0;
  for (int y = 0; y < 1027; ++y)
    expected +=
        (0.2 + y / 1027.0) * 2 * std::numbers::pi *
        (std::cos(std::numbers::pi * y / 1027) - std::cos(std::numbers::pi * (y + 1) / 1027));
  expected += 5000 * std::sin(std::numbers::pi * 256.5 / 1027) * 2 * std::numbers::pi *
              std::numbers::pi / (2050.0 * 1027);
  EXPECT_NEAR(total.mean(), expected, 4.5 * total.error() + 1e-3 * expected);
}

TEST(EnvironmentImage, UnusableValuesAreMended) {
  const Image image = lat_long(8, 4, [](int x, int) {
    return x == 0 ? std::nanf("") : (x == 1 ? -1.0f : (x == 2 ? infinity : 1.0f));
  });
  const ImageLight made(image, sky(Rgb(1)));
  EXPECT_NEAR(over_sphere([&](const Vec3f& d) -> double {
                const float radiance = escaped_radiance(*made.light, d).x;
                EXPECT_TRUE(radiance >= 0 && radiance <= 65504);
                return static_cast<double>(made.light->incident_pdf({}, d));
              }),
              1, 5e-3);
}

TEST(EnvironmentImage, MendingIsToldOfEachKind) {
  const auto notes = [](float (*value)(int, int), float radiance) {
    std::vector<std::string> lines;
    const RenderSpace space{{}, 1};
    const OccupiedRegion region = region_of({cube({}, 1)});
    make_environment_image(lat_long(8, 4, value), "sky.exr", sky(Rgb(radiance)),
                           LightContext{{0, 1, 0}, space, region, &lines});
    return lines;
  };
  EXPECT_TRUE(notes([](int x, int) { return static_cast<float>(x); }, 1).empty());
  const std::vector<std::string> lines = notes(
      [](int x, int y) {
        return x > 2 ? 1.0f : x == 0 ? std::nanf("") : x == 1 ? -1.0f : y == 0 ? infinity : 1.0f;
      },
      1);
  EXPECT_EQ(lines,
            (std::vector<std::string>{
                "light.image sky.exr: 3 values of infinity, taken for 65504, the largest half "
                "float: the light may lack power",
                "light.image sky.exr: 12 values below 0, taken for 0",
                "light.image sky.exr: 12 values that are no numbers, taken for 0"}));
  EXPECT_EQ(notes([](int, int) { return 1e20f; }, 1e20f).size(), 1u);
}

TEST(EnvironmentImage, BlackImageGivesNoLight) {
  const ImageLight made(lat_long(8, 4, [](int, int) { return 0.0f; }), sky(Rgb(1)),
                        region_of({cube({}, 1)}));
  EXPECT_EQ(made.light->sample_incident({}, 0.3f, 0.6f).value, Rgb());
  EXPECT_EQ(made.light->incident_pdf({}, {0, 1, 0}), 0);
  EXPECT_EQ(made.light->power(), Rgb());
}

TEST(EnvironmentImage, ExtremeRadianceStaysFinite) {
  for (const float radiance : {1e-20f, 1e20f}) {
    const ImageLight made(sunny_sky(), sky(Rgb(radiance)), region_of({cube({}, 1)}));
    const IncidentSample s = made.light->sample_incident({}, 0.3f, 0.6f);
    EXPECT_TRUE(std::isfinite(s.value.x) && s.value.x > 0);
    EXPECT_TRUE(std::isfinite(made.light->power().x) && made.light->power().x > 0);
  }
}

TEST(EnvironmentImage, RefusesImagesWithoutColour) {
  Image image = lat_long(8, 4, [](int, int) { return 1.0f; });
  image.channels[1].name = "normal.Y";
  EXPECT_THROW(ImageLight(image, sky(Rgb(1))), InputError);
  image.channels.resize(1);
  image.channels[0].name = "Y";
  EXPECT_NEAR(escaped_radiance(*ImageLight(image, sky(Rgb(1))).light, {1, 0, 0}).y, 1, 1e-6);
  image.channels[0].data.pop_back();
  EXPECT_THROW(ImageLight(image, sky(Rgb(1))), InputError);
}

} // namespace
} // namespace vdbeam
