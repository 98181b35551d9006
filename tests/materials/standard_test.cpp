// The standard surface: energy, reciprocity, sampling, limits that other materials have.
#include "materials/fresnel.h"
#include "materials/material_table.h"
#include "math/sampling.h"
#include "support/chi_squared.h"
#include "support/render_passes.h"
#include "support/statistics.h"
#include "support/surface_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

struct Look {
  double roughness, metal, coat, coat_roughness;
};
constexpr Look looks[] = {{0.5, 0, 0, 0.05},  {0.05, 0, 0, 0.05},  {1, 0, 0, 0.05},
                          {0.3, 1, 0, 0.05},  {0.6, 0.4, 0, 0.05}, {0.7, 0, 1, 0.3},
                          {0.7, 1, 0.5, 0.1}, {0.8, 0.5, 1, 0.8},  {0, 0, 1, 0}};

MaterialSettings settings_of(const Look& look, const Rgb& albedo = Rgb(1)) {
  MaterialSettings settings;
  settings.type = MaterialType::standard;
  settings.albedo = albedo;
  settings.roughness = look.roughness;
  settings.metal = look.metal;
  settings.coat = look.coat;
  settings.coat_roughness = look.coat_roughness;
  return settings;
}
std::unique_ptr<Material> standard(const Look& look, const Rgb& albedo = Rgb(1)) {
  return make_material(settings_of(look, albedo), 1);
}
Vec3f standard_direction(double degrees, float side = 1) {
  const auto radians = static_cast<float>(degrees * M_PI / 180);
  return {std::sin(radians), 0, side * std::cos(radians)};
}
test::Samples furnace(const Material& material, const Vec3f& wo, int channel = 0) {
  test::Samples samples;
  Rng rng({}, RngStage::test, 0);
  for (int i = 0; i < 100000; ++i)
    samples.add(static_cast<double>(material.sample(wo, Carried::radiance, rng).weight[channel]));
  return samples;
}
std::ostream& operator<<(std::ostream& out, const Look& look) {
  return out << look.roughness << " " << look.metal << " " << look.coat;
}

/// In a white furnace a white base under a glossy layer sends back exactly what it gets, also under
/// a coat; metal loses what its facets reflect twice, and no surface gives more than it gets.
TEST(Standard, KeepsEnergy) {
  for (const Look& look : looks)
    for (const double angle : {0.0, 30.0, 60.0, 85.0, 89.0})
      for (const float side : {1.0f, -1.0f}) {
        const test::Samples light = furnace(*standard(look), standard_direction(angle, side));
        SCOPED_TRACE(testing::Message() << look << " at " << angle);
        EXPECT_LT(light.mean(), 1 + 0.004 + 4 * light.error());
        if (look.metal == 0) {
          // Facets that reflect downwards are all that is missing.
          EXPECT_GT(light.mean(), 1 - 0.004 - 4 * light.error());
        } else {
          EXPECT_GT(light.mean(), 0.55);
        }
      }
}

TEST(Standard, DirectionsCanBeExchanged) {
  Rng rng({}, RngStage::test, 2);
  for (const Look& look : looks) {
    const auto material = standard(look, {0.9f, 0.5f, 0.2f});
    for (int i = 0; i < 500; ++i) {
      const float u1 = rng.uniform(), v1 = rng.uniform(), u2 = rng.uniform(), v2 = rng.uniform();
      const Vec3f a = sample_sphere(u1, v1), b = sample_sphere(u2, v2);
      for (int c = 0; c < 3; ++c) {
        const float ab = material->evaluate(a, b)[c] / std::abs(b.z);
        const float ba = material->evaluate(b, a)[c] / std::abs(a.z);
        EXPECT_NEAR(ab, ba, 2e-3f * (ab + ba)) << look;
      }
    }
  }
}

/// Seen from elsewhere the matt part changes by its albedo alone, and it is no more than the whole.
TEST(Standard, MattPartChangesByItsAlbedoAlone) {
  Rng rng({}, RngStage::test, 4);
  for (const Look& look : looks) {
    const auto material = standard(look, {0.9f, 0.5f, 0.2f});
    for (int i = 0; i < 200; ++i) {
      const float u = rng.uniform(), v = rng.uniform();
      Vec3f wi = sample_sphere(u, v);
      wi.z = std::abs(wi.z);
      const Vec3f a = standard_direction(20), b = standard_direction(70);
      for (int c = 0; c < 3; ++c) {
        const float of_a = material->matt(a, wi)[c], of_b = material->matt(b, wi)[c];
        EXPECT_LE(of_a, material->evaluate(a, wi)[c] * 1.0001f) << look;
        EXPECT_NEAR(of_a * material->matt_albedo(b)[c], of_b * material->matt_albedo(a)[c],
                    1e-5f * of_a)
            << look;
      }
    }
    EXPECT_EQ(max_component(material->matt_albedo(standard_direction(20))) > 0, look.metal < 1)
        << look;
  }
}

/// Sampled reflectance against `evaluate` at uniform directions.
TEST(Standard, SampledAndEvaluatedReflectanceAgree) {
  for (const Look& look : looks) {
    if (look.roughness < 0.3 || (look.coat > 0 && look.coat_roughness < 0.3))
      continue; // uniform directions would miss the lobe
    const auto material = standard(look, {0.8f, 0.3f, 0});
    for (const double angle : {0.0, 40.0, 75.0})
      for (const int channel : {0, 2}) {
        const Vec3f wo = standard_direction(angle, -1);
        test::Samples uniform;
        Rng rng({}, RngStage::test, 1);
        for (int i = 0; i < 400000; ++i) {
          const float u = rng.uniform(), v = rng.uniform();
          uniform.add(static_cast<double>(material->evaluate(wo, sample_sphere(u, v))[channel]) *
                      4 * M_PI);
        }
        SCOPED_TRACE(testing::Message() << look << " at " << angle);
        test::expect_same_mean(furnace(*material, wo, channel), uniform);
      }
  }
}

/// Bins of equal solid angle above: directions drawn against the integral of the stated density.
TEST(Standard, DirectionsAreDrawnByTheStatedDensity) {
  constexpr int rows = 16, columns = 16, draws = 100000, fine = 12;
  for (const Look& look : {Look{0.7, 0, 0, 0}, Look{0.8, 0.5, 0.6, 0.6}})
    for (const double angle : {10.0, 60.0}) {
      const auto material = standard(look, Rgb(0.6f));
      const Vec3f wo = standard_direction(angle);
      std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
      Rng rng({}, RngStage::test, 3);
      for (int i = 0; i < draws; ++i) {
        const MaterialSample sample = material->sample(wo, Carried::radiance, rng);
        if (!(sample.pdf > 0)) {
          ++counts.back();
          continue;
        }
        EXPECT_NEAR(sample.pdf, material->pdf(wo, sample.wi), 1e-4f * sample.pdf);
        const double turn = std::atan2(sample.wi.y, sample.wi.x) / (2 * M_PI) + 0.5;
        const int row = std::min(rows - 1, static_cast<int>(sample.wi.z * rows));
        const int column = std::min(columns - 1, static_cast<int>(turn * columns));
        ++counts[static_cast<std::size_t>(row * columns + column)];
      }
      double total = 0;
      for (int row = 0; row < rows * fine; ++row)
        for (int column = 0; column < columns * fine; ++column) {
          const double z = (row + 0.5) / (rows * fine);
          const double phi = 2 * M_PI * ((column + 0.5) / (columns * fine) - 0.5);
          const double r = std::sqrt(1 - z * z);
          const Vec3f wi(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
          const double share = static_cast<double>(material->pdf(wo, wi)) * 2 * M_PI /
                               (rows * columns * fine * fine) * draws;
          expected[static_cast<std::size_t>(row / fine * columns + column / fine)] += share;
          total += share;
        }
      expected.back() = draws - total; // facets that reflect downwards
      EXPECT_GT(test::chi_squared_test(counts, expected), 1e-4) << look << " at " << angle;
    }
}

/// All metal is the conductor of that colour; a black base shows the reflectance of its layer.
TEST(Standard, LimitsAreOtherMaterials) {
  MaterialSettings conductor;
  conductor.type = MaterialType::conductor;
  conductor.roughness = 0.4;
  conductor.reflectance = {0.9f, 0.6f, 0.3f};
  const auto metal = make_material(conductor, 1);
  const auto same = standard({0.4, 1, 0, 0}, conductor.reflectance);
  for (const double angle : {5.0, 50.0, 80.0}) {
    const Vec3f wo = standard_direction(angle), wi = standard_direction(-angle + 8);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(same->evaluate(wo, wi)[c], metal->evaluate(wo, wi)[c],
                  1e-4f * metal->evaluate(wo, wi)[c]);
    float cos_t = 0;
    const double smooth = static_cast<double>(fresnel_dielectric(wo.z, 1.5f, cos_t));
    EXPECT_NEAR(furnace(*standard({0.02, 0, 0, 0}, Rgb(0)), wo).mean(), smooth, 0.01 * smooth);
  }
}

/// A texture colours the base and the reflections of metal, not those of the layers above.
TEST(Standard, TexturesColourTheBase) {
  const Vec3f wo = standard_direction(40), wi = standard_direction(-35);
  for (const Look& look : looks) {
    const auto white = standard(look), dim = standard(look, Rgb(0.25f));
    const Rgb rest = white->untextured(wo, wi);
    const Rgb by_texture = (white->evaluate(wo, wi) - rest) * 0.25f + rest;
    EXPECT_NEAR(by_texture.x, dim->evaluate(wo, wi).x, 1e-4f * by_texture.x) << look;
  }
}

/// A lit wall, by every estimator; shadow rays and sampled directions are combined.
TEST(Standard, EveryEstimatorShadesIt) {
  using namespace test::surfaces;
  test::MemoryScene scene;
  scene.add_box({-0.5, -0.5, 0.3}, {0.5, 0.5, 0.8}).extinction = 0.5;
  add_surface(scene, SurfaceShape::quad, scaled(2),
              settings_of({0.3, 0.3, 0.5, 0.1}, {0.7f, 0.4f, 0.1f}));
  add_surface(scene, SurfaceShape::quad, moved(scaled(0.5), {1.5, 0, 2}, true), shining(8));
  scene.add_light(LightType::environment).radiance = Rgb(0.2f);
  scene.look({-1.5, 0.5, 3}, {0, 0, 0}, 40, 12, 12);
  scene.scene.render.photons = 20000;
  const test::PassMeans path = render_passes(scene, EstimatorType::path, 300);
  test::expect_power(path.total[0], 0.02 * path.total[0].mean());
  for (const EstimatorType& estimator :
       {EstimatorType::beam, EstimatorType::march, EstimatorType::gather}) {
    SCOPED_TRACE(estimator.name);
    const test::PassMeans means = render_passes(scene, estimator, 48);
    for (std::size_t c = 0; c < 3; ++c)
      test::expect_same_mean(means.total[c], path.total[c], 0.02 * path.total[c].mean());
  }
}

} // namespace
} // namespace vdbeam
