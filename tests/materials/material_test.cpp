#include "materials/material_table.h"

#include "materials/fresnel.h"
#include "math/sampling.h"
#include "support/chi_squared.h"
#include "support/statistics.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

std::unique_ptr<Material> conductor(double roughness, const Rgb& reflectance = Rgb(1)) {
  MaterialSettings settings;
  settings.type = MaterialType::conductor;
  settings.roughness = roughness;
  settings.reflectance = reflectance;
  return make_material(settings, 1);
}
std::unique_ptr<Material> diffuse(const Rgb& albedo) {
  MaterialSettings settings;
  settings.albedo = albedo;
  return make_material(settings, 1);
}
std::unique_ptr<Material> glass(double ior, double roughness = 0) {
  MaterialSettings settings;
  settings.roughness = roughness;
  settings.type = MaterialType::dielectric;
  settings.ior = ior;
  return make_material(settings, 1);
}
Vec3f at_angle(double degrees, float side = 1) {
  const auto radians = static_cast<float>(degrees * M_PI / 180);
  return {std::sin(radians), 0, side * std::cos(radians)};
}
/// Reflectance of a light that is the same all around, by sampling.
test::Samples furnace(const Material& material, const Vec3f& wo, Carried carried) {
  test::Samples samples;
  Rng rng({}, RngStage::test, 0);
  for (int i = 0; i < 200000; ++i)
    samples.add(static_cast<double>(material.sample(wo, carried, rng).weight.x));
  return samples;
}
/// The same by uniform directions and `evaluate`.
test::Samples uniform_furnace(const Material& material, const Vec3f& wo) {
  test::Samples samples;
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 400000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    samples.add(static_cast<double>(material.evaluate(wo, sample_sphere(u, v)).x) * 4 * M_PI);
  }
  return samples;
}

TEST(Materials, sampled_and_evaluated_reflectance_agree) {
  for (const float side : {1.0f, -1.0f})
    for (const double angle : {0.0, 40.0, 75.0}) {
      const Vec3f wo = at_angle(angle, side);
      for (const double roughness : {0.5, 0.8, 1.0})
        test::expect_same_mean(furnace(*conductor(roughness, Rgb(0.6f)), wo, Carried::radiance),
                               uniform_furnace(*conductor(roughness, Rgb(0.6f)), wo));
      test::expect_same_mean(furnace(*diffuse(Rgb(0.7f)), wo, Carried::power),
                             uniform_furnace(*diffuse(Rgb(0.7f)), wo));
    }
}

/// The ways on from glass are those between which samples choose, with the chances as weights.
TEST(Materials, both_ways_of_glass_are_what_samples_choose_between) {
  for (const float side : {1.0f, -1.0f})
    for (const double angle : {0.0, 30.0, 60.0})
      for (const Carried carried : {Carried::radiance, Carried::power}) {
        const auto clear = glass(1.5);
        const Vec3f wo = at_angle(angle, side);
        const SpecularBranches ways = clear->branches(wo, carried);
        test::Samples reflected, refracted;
        Rng rng({}, RngStage::test, 7);
        for (int i = 0; i < 20000; ++i) {
          const MaterialSample sample = clear->sample(wo, carried, rng);
          const bool up = sample.wi.z * wo.z > 0;
          const MaterialSample& way = up ? ways.reflected : ways.refracted;
          EXPECT_EQ(sample.wi, way.wi);
          reflected.add(up ? static_cast<double>(sample.weight.x) : 0);
          refracted.add(up ? 0 : static_cast<double>(sample.weight.x));
        }
        test::expect_mean(reflected, static_cast<double>(ways.reflected.weight.x), 1e-6);
        test::expect_mean(refracted, static_cast<double>(ways.refracted.weight.x), 1e-6);
      }
}

/// What each way carries on average is the same, also where facets reflect all light.
TEST(Materials, both_ways_of_rough_glass_carry_what_samples_do) {
  for (const float side : {1.0f, -1.0f})
    for (const double angle : {0.0, 40.0, 70.0}) {
      const auto rough = glass(1.5, 0.4);
      const Vec3f wo = at_angle(angle, side);
      test::Samples chosen[2], both[2]; // refracted, reflected
      Rng rng({}, RngStage::test, 11);
      for (int i = 0; i < 20000; ++i) {
        const MaterialSample sample = rough->sample(wo, Carried::radiance, rng);
        const bool up = sample.wi.z * wo.z > 0;
        chosen[up].add(static_cast<double>(sample.weight.x));
        chosen[!up].add(0);
        const SpecularBranches ways = rough->both_ways(wo, Carried::radiance, rng);
        both[1].add(static_cast<double>(ways.reflected.weight.x));
        both[0].add(static_cast<double>(ways.refracted.weight.x));
        if (ways.reflected.weight.x > 0) {
          EXPECT_FLOAT_EQ(ways.reflected.pdf, rough->pdf(wo, ways.reflected.wi));
        }
      }
      test::expect_same_mean(chosen[0], both[0]);
      test::expect_same_mean(chosen[1], both[1]);
      EXPECT_LE(both[1].variance(), chosen[1].variance());
    }
}

/// Rough glass reflects and refracts; the bright peak of transmission takes the most samples.
TEST(Materials, rough_glass_is_sampled_as_it_is_evaluated) {
  for (const float side : {1.0f, -1.0f})
    for (const double angle : {0.0, 40.0, 75.0})
      for (const double roughness : {0.6, 0.9}) {
        const auto rough = glass(1.5, roughness);
        test::expect_same_mean(furnace(*rough, at_angle(angle, side), Carried::radiance),
                               uniform_furnace(*rough, at_angle(angle, side)));
      }
}

/// What facets send a second way is lost, and nothing else: little where they are smooth. Of
/// radiance that goes in, the square of the index is taken back as it comes out.
TEST(Materials, rough_glass_keeps_light) {
  for (const double angle : {0.0, 30.0, 60.0})
    for (const double ior : {0.5, 1.5, 4.0})
      for (const float side : {1.0f, -1.0f})
        for (const double roughness : {0.05, 0.3, 1.0}) {
          const auto rough = glass(ior, roughness);
          const double light = furnace(*rough, at_angle(angle, side), Carried::power).mean();
          EXPECT_LE(light, 1 + 1e-5);
          EXPECT_GT(light, roughness < 0.1   ? 0.99
                           : roughness < 0.5 ? 0.8
                                             : 0.2)
              << angle << " " << ior << " " << side << " " << roughness;
        }
}

/// Helmholtz reciprocity: f(a, b) / eta^2 is the same both ways (Veach 1997, 5.2).
TEST(Materials, directions_can_be_exchanged_through_rough_glass) {
  Rng rng({}, RngStage::test, 5);
  int through = 0;
  for (int i = 0; i < 2000; ++i) {
    const float u1 = rng.uniform(), v1 = rng.uniform(), u2 = rng.uniform(), v2 = rng.uniform();
    const Vec3f a = sample_sphere(u1, v1), b = sample_sphere(u2, v2);
    const auto rough = glass(1.5, 0.8);
    float ab = rough->evaluate(a, b).y / std::abs(b.z);
    const float ba = rough->evaluate(b, a).y / std::abs(a.z);
    if (a.z * b.z < 0) // ab is of light that comes from b's side
      ab *= a.z > 0 ? 2.25f : 1 / 2.25f;
    EXPECT_NEAR(ab, ba, 2e-3f * (ab + ba) + 1e-6f);
    through += a.z * b.z < 0 && ab > 0;
  }
  EXPECT_GT(through, 100);
}

/// As roughness goes to 0, Fresnel's share of smooth glass.
TEST(Materials, nearly_smooth_glass_reflects_as_smooth_glass) {
  Rng rng({}, RngStage::test, 6);
  const auto rough = glass(1.5, 0.03);
  const Vec3f wo = at_angle(60);
  test::Samples reflected;
  for (int i = 0; i < 100000; ++i)
    reflected.add(rough->sample(wo, Carried::power, rng).wi.z > 0 ? 1 : 0);
  test::expect_mean(reflected, 0.0891867, 1e-3);
}

TEST(Materials, nothing_gives_more_light_than_it_gets) {
  for (const double angle : {0.0, 30.0, 60.0, 85.0, 89.9}) {
    for (const double roughness : {0.0, 0.01, 0.3, 1.0}) {
      const test::Samples metal = furnace(*conductor(roughness), at_angle(angle), Carried::power);
      EXPECT_LE(metal.mean(), 1 + 1e-5) << roughness << " " << angle;
      // Light that facets would reflect a second time is lost: little on smooth ones.
      EXPECT_GT(metal.mean(), roughness <= 0.3 ? 0.85 : 0.3) << roughness << " " << angle;
    }
    EXPECT_NEAR(furnace(*diffuse(Rgb(1)), at_angle(angle), Carried::power).mean(), 1, 1e-6);
    for (const double ior : {0.5, 1.5, 4.0})
      for (const float side : {1.0f, -1.0f})
        EXPECT_NEAR(furnace(*glass(ior), at_angle(angle, side), Carried::power).mean(), 1, 1e-6);
  }
}

TEST(Materials, directions_can_be_exchanged) {
  Rng rng({}, RngStage::test, 2);
  for (int i = 0; i < 1000; ++i) {
    const float u1 = rng.uniform(), v1 = rng.uniform(), u2 = rng.uniform(), v2 = rng.uniform();
    const Vec3f a = sample_sphere(u1, v1), b = sample_sphere(u2, v2);
    for (const double roughness : {0.3, 0.9}) {
      const auto metal = conductor(roughness, {0.9f, 0.5f, 0.2f});
      const float ab = metal->evaluate(a, b).y / std::abs(b.z);
      const float ba = metal->evaluate(b, a).y / std::abs(a.z);
      EXPECT_NEAR(ab, ba, 1e-3f * (ab + ba));
    }
  }
}

/// Bins of equal solid angle: directions drawn against the integral of the stated density.
double sampling_p_value(const Material& material, const Vec3f& wo) {
  constexpr int rows = 20, columns = 20, draws = 200000, fine = 12;
  std::vector<double> counts(rows * columns + 1), expected(rows * columns + 1);
  Rng rng({}, RngStage::test, 3);
  for (int i = 0; i < draws; ++i) {
    const MaterialSample sample = material.sample(wo, Carried::radiance, rng);
    if (!(sample.pdf > 0)) {
      ++counts.back();
      continue;
    }
    const double turn = std::atan2(sample.wi.y, sample.wi.x) / (2 * M_PI) + 0.5;
    const int row = std::min(rows - 1, static_cast<int>((sample.wi.z + 1) / 2 * rows));
    const int column = std::min(columns - 1, static_cast<int>(turn * columns));
    ++counts[static_cast<std::size_t>(row * columns + column)];
  }
  double total = 0;
  for (int row = 0; row < rows * fine; ++row)
    for (int column = 0; column < columns * fine; ++column) {
      const double z = 2 * (row + 0.5) / (rows * fine) - 1;
      const double phi = 2 * M_PI * ((column + 0.5) / (columns * fine) - 0.5);
      const double r = std::sqrt(1 - z * z);
      const Vec3f wi(Vec3d{r * std::cos(phi), r * std::sin(phi), z});
      const double share = static_cast<double>(material.pdf(wo, wi)) * 4 * M_PI /
                           (rows * columns * fine * fine) * draws;
      expected[static_cast<std::size_t>(row / fine * columns + column / fine)] += share;
      total += share;
    }
  expected.back() = draws - total; // facets that reflect downwards
  return test::chi_squared_test(counts, expected);
}

TEST(Materials, directions_are_drawn_by_the_stated_density) {
  for (const double angle : {10.0, 60.0}) {
    EXPECT_GT(sampling_p_value(*diffuse(Rgb(1)), at_angle(angle)), 1e-4);
    EXPECT_GT(sampling_p_value(*conductor(0.7), at_angle(angle)), 1e-4) << angle;
    EXPECT_GT(sampling_p_value(*glass(1.5, 0.8), at_angle(angle)), 1e-4) << angle;
    EXPECT_GT(sampling_p_value(*glass(1.5, 0.9), at_angle(angle, -1)), 1e-4) << angle;
    EXPECT_GT(sampling_p_value(*conductor(1), at_angle(angle, -1)), 1e-4) << angle;
  }
}

TEST(Fresnel, known_values) {
  float cos_t = 0;
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f, cos_t), 0.04f, 1e-6f);
  EXPECT_NEAR(cos_t, 1, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(0.5f, 1.5f, cos_t), 0.0891867f, 1e-6f);
  // At Brewster's angle only light polarised across is reflected, cos^2(2 theta) of it.
  const float brewster = std::atan(1.5f);
  const float across = std::cos(2 * brewster);
  EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.5f, cos_t), 0.5f * across * across, 1e-6f);
  EXPECT_EQ(fresnel_dielectric(0.5f, 1 / 1.5f, cos_t), 1) << "total reflection";
  EXPECT_NEAR(fresnel_dielectric(0.3f, 1, cos_t), 0, 1e-12f) << "no interface";
  EXPECT_NEAR(fresnel_dielectric(1e-4f, 1.5f, cos_t), 1, 1e-3f);
}

TEST(Dielectric, obeys_snell_and_scales_radiance) {
  Rng rng({}, RngStage::test, 4);
  const auto ball = glass(1.5);
  const Vec3f wo = at_angle(50);
  for (int i = 0; i < 100; ++i) {
    const MaterialSample sample = ball->sample(wo, Carried::radiance, rng);
    if (sample.wi.z > 0) {
      EXPECT_NEAR(sample.wi.z, wo.z, 1e-6f);
      EXPECT_EQ(sample.weight.x, 1);
      continue;
    }
    EXPECT_NEAR(-sample.wi.x * 1.5f, wo.x, 1e-5f);
    EXPECT_NEAR(sample.weight.x, 1 / (1.5f * 1.5f), 1e-6f);
  }
}

/// What the plan and all who follow light ask a material.
struct Policies {
  MaterialSettings settings;
  /// In the order of `of`.
  std::string answers;

  static std::string of(const Material& material) {
    std::string text;
    const auto add = [&](bool yes, const char* word) {
      text += yes ? std::string(" ") + word : "";
    };
    add(material.is_black(), "black");
    add(material.is_specular(), "specular");
    add(material.shows_surroundings(), "shows");
    add(material.takes_photons(), "takes");
    add(material.throws_light(), "throws");
    add(material.refracts(), "refracts");
    add(material.shines(), "shines");
    return text;
  }
};

/// A material whose other settings are as by default.
MaterialSettings of_type(const MaterialType& type) {
  MaterialSettings settings;
  settings.type = type;
  return settings;
}
template <class T, class V>
MaterialSettings with(MaterialSettings settings, T MaterialSettings::*member, const V& value) {
  settings.*member = value;
  return settings;
}

TEST(Materials, policies_of_each_kind) {
  using M = MaterialSettings;
  const MaterialSettings diffuse = of_type(MaterialType::diffuse),
                         mirror = of_type(MaterialType::mirror),
                         metal = of_type(MaterialType::conductor),
                         glass = of_type(MaterialType::dielectric),
                         lamp = of_type(MaterialType::emissive);
  const Rgb black(0);
  const std::vector<Policies> cases{
      {diffuse, " takes"},
      {with(diffuse, &M::albedo, black), " black"},
      {of_type(MaterialType::shadow_catcher), " takes"},
      {mirror, " specular shows throws"},
      {with(mirror, &M::reflectance, black), " black specular"},
      {metal, " shows throws"},
      {with(metal, &M::roughness, 0), " specular shows throws"},
      {with(metal, &M::roughness, 0.54), " shows throws"},
      {with(metal, &M::roughness, 0.56), " takes throws"},
      {with(metal, &M::reflectance, black), " black"},
      {of_type(MaterialType::standard), " takes"},
      {with(with(of_type(MaterialType::standard), &M::metal, 1), &M::roughness, 0.2),
       " shows throws"},
      {with(of_type(MaterialType::standard), &M::metal, 1), " shows throws"},
      {with(with(of_type(MaterialType::standard), &M::metal, 1), &M::roughness, 0.6),
       " takes throws"},
      {glass, " specular shows throws refracts"},
      {with(glass, &M::roughness, 0.54), " shows throws refracts"},
      {with(glass, &M::roughness, 0.56), " takes throws refracts"},
      {with(with(glass, &M::roughness, 0.56), &M::ior, 1), " specular shows throws refracts"},
      {lamp, " black specular shines"},
      {with(lamp, &M::radiance, black), " black specular"},
      {of_type(MaterialType::holdout), " black specular"}};
  for (const Policies& expected : cases)
    EXPECT_EQ(Policies::of(*make_material(expected.settings, 1)), expected.answers)
        << expected.settings.type.name;
}

TEST(Materials, colours_of_each_kind_are_those_of_its_own_keys) {
  using M = MaterialSettings;
  using T = MaterialType;
  const Rgb red{1, 0, 0};
  const std::vector<MaterialSettings> colored{
      with(of_type(T::diffuse), &M::albedo, red),
      with(of_type(T::shadow_catcher), &M::albedo, red),
      with(of_type(T::diffuse), &M::texture, "picture.png"),
      with(of_type(T::standard), &M::albedo, red),
      with(of_type(T::mirror), &M::reflectance, red),
      with(of_type(T::conductor), &M::reflectance, red),
      with(of_type(T::dielectric), &M::absorption, red),
      with(of_type(T::emissive), &M::radiance, red),
      with(of_type(T::emissive), &M::texture, "picture.png")};
  for (const MaterialSettings& settings : colored) {
    const MaterialKind& kind = material_kind(settings.type);
    EXPECT_TRUE(kind.colored(settings)) << kind.name;
    EXPECT_FALSE(kind.colored(of_type(settings.type))) << kind.name;
  }
  EXPECT_FALSE(mirror_material.colored(with(of_type(T::mirror), &M::albedo, red)));
}

TEST(Materials, unknown_kinds_are_errors) {
  EXPECT_THROW(make_material(of_type({"velvet"}), 1), InputError);
}

} // namespace
} // namespace vdbeam
