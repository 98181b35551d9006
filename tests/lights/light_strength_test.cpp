// Kelvin, exposure and power, which every kind of light has in its own way.
#include "lights/light_test_scene.h"
#include "volume/blackbody.h"

#include <array>

namespace vdbeam {
namespace {

using namespace test;

/// Chromaticity of linear RGB with Rec.709 primaries (IEC 61966-2-1).
std::array<double, 2> chromaticity(const Vec3d& c) {
  const Vec3d xyz{0.4124564 * c.x + 0.3575761 * c.y + 0.1804375 * c.z,
                  0.2126729 * c.x + 0.7151522 * c.y + 0.0721750 * c.z,
                  0.0193339 * c.x + 0.1191920 * c.y + 0.9503041 * c.z};
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

/// Points of the Planckian locus (Wyszecki and Stiles, Color Science, 2000, table 1(3.11)).
TEST(LightTint, LiesOnThePlanckianLocus) {
  struct Known {
    double kelvin, x, y;
  };
  for (const Known& known : {Known{2856, 0.4476, 0.4075}, Known{4000, 0.3804, 0.3767},
                             Known{6500, 0.3135, 0.3236}, Known{10000, 0.2807, 0.2883}}) {
    const Vec3d tint(light_tint(known.kelvin, 0, ColorSpace::rec709));
    EXPECT_NEAR(chromaticity(tint)[0], known.x, 5e-4) << known.kelvin;
    EXPECT_NEAR(chromaticity(tint)[1], known.y, 5e-4) << known.kelvin;
    EXPECT_NEAR(luminance(tint), 1, 1e-5);
  }
  EXPECT_EQ(light_tint({}, 3, ColorSpace::rec709), Rgb(8));
  EXPECT_EQ(light_tint({}, 0, ColorSpace::acescg), Rgb(1));
}

TEST(LightTint, MultipliesEveryKindOfLight) {
  const Rgb tint = light_tint(3200.0, -1.5, ColorSpace::rec709);
  for (const LightKind* kind : light_table()) {
    LightSettings settings;
    settings.type = {kind->name};
    settings.position = {0, 3, 0};
    settings.angular_radius = 1;
    const MadeLight white(settings, region_of({cube({}, 1)}));
    settings.kelvin = 3200;
    settings.exposure = -1.5;
    const LightContext context{{0, 1, 0}, white.space, white.region};
    const std::unique_ptr<Light> made = make_light(settings, context);
    for (const float u : {0.1f, 0.7f}) {
      // Skies draw by their own colours, so what is seen of them is compared.
      const Vec3f seen_at = sample_sphere(u, 0.4f);
      const Rgb before = kind->surrounds
                             ? escaped_radiance(*white.light, seen_at)
                             : white.light->sample_incident({0.1f, 0.2f, 0}, u, 0.4f).value;
      const Rgb after = kind->surrounds ? escaped_radiance(*made, seen_at)
                                        : made->sample_incident({0.1f, 0.2f, 0}, u, 0.4f).value;
      EXPECT_GT(max_component(before), 0) << kind->name;
      Rng rng({}, RngStage::test, 1), same({}, RngStage::test, 1);
      const Rgb flux = made->emit(0.3, rng).flux, plain = white.light->emit(0.3, same).flux;
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(after[c], before[c] * tint[c], 1e-5f * before[c]) << kind->name;
        EXPECT_NEAR(made->power()[c], white.light->power()[c] * tint[c],
                    (kind->surrounds ? 3e-2f : 1e-5f) * made->power()[c])
            << kind->name;
        if (!kind->surrounds) {
          EXPECT_NEAR(flux[c], plain[c] * tint[c], 1e-5f * plain[c]) << kind->name;
        }
      }
    }
  }
}

TEST(LightPower, OfPointsAndSpotsIsTheirIntensityOverAllDirections) {
  LightSettings settings;
  settings.type = LightType::point;
  settings.power = Rgb(40);
  settings.position = {0, 3, 0};
  const MadeLight point(settings, region_of({cube({}, 1)}));
  EXPECT_NEAR(point.light->sample_incident({0, 1, 0}, 0, 0).value.x, 40 / (4 * pi) / 4, 1e-5);
  settings.type = LightType::spot;
  settings.direction = {0, -1, 0};
  settings.cone_angle = 60;
  settings.cone_falloff = 0; // 2 pi (1 - cos 60) = pi
  const MadeLight spot(settings, region_of({cube({}, 1)}));
  EXPECT_NEAR(spot.light->sample_incident({0, 1, 0}, 0, 0).value.x, 40 / pi / 4, 1e-5);
}

} // namespace
} // namespace vdbeam
