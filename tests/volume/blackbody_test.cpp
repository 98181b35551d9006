#include "volume/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

struct Locus {
  double kelvin, x, y;
};

/// The Planckian locus in the CIE 1931 diagram (Wyszecki and Stiles, Color Science, 1982, table
/// 1(3.11)).
TEST(Blackbody, LiesOnThePlanckianLocus) {
  for (const Locus& locus : {Locus{1000, 0.6528, 0.3444},
                             {1500, 0.5857, 0.3931},
                             {2000, 0.5267, 0.4133},
                             {3000, 0.4369, 0.4041},
                             {4000, 0.3805, 0.3768},
                             {5000, 0.3451, 0.3516},
                             {6500, 0.3135, 0.3237},
                             {10000, 0.2807, 0.2884}}) {
    const Vec3d c = planck_xyz(locus.kelvin);
    const double sum = c.x + c.y + c.z;
    EXPECT_NEAR(c.x / sum, locus.x, 0.0005) << locus.kelvin;
    EXPECT_NEAR(c.y / sum, locus.y, 0.0005) << locus.kelvin;
  }
}

/// Standard illuminant A is a black body of 2856 K: x = 0.4476, y = 0.4074 (CIE 15).
TEST(Blackbody, IlluminantA) {
  const Vec3d c = planck_xyz(2855.54);
  EXPECT_NEAR(c.x / (c.x + c.y + c.z), 0.4476, 0.0003);
  EXPECT_NEAR(c.y / (c.x + c.y + c.z), 0.4074, 0.0003);
}

/// Luminance of a black body at the freezing point of platinum, 2041.4 K: by the old definition of
/// the candela 60 cd/cm^2, with 683 lm/W.
TEST(Blackbody, LuminanceOfTheCandela) {
  EXPECT_NEAR(683 * planck_xyz(2041.4).y, 6e5, 0.015 * 6e5);
}

TEST(Blackbody, WhiteIsNeutral) {
  // D65's white point has equal components.
  const Vec3d rgb = xyz_to_rgb({0.95047, 1, 1.08883});
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(rgb[c], 1, 1e-4);
  // 6504 K is not D65, but near.
  const Vec3d near = blackbody_color(6504);
  EXPECT_NEAR(near.x, 1, 0.06);
  EXPECT_NEAR(near.y, 1, 0.03);
  EXPECT_NEAR(near.z, 1, 0.06);
}

TEST(Blackbody, ColoursHaveLuminanceOneAndAreDisplayable) {
  double red = 1e9, blue = 0;
  for (double kelvin = 10; kelvin < 1e6; kelvin *= 1.07) {
    const Vec3d rgb = blackbody_color(kelvin);
    EXPECT_NEAR(luminance(rgb), 1, 2e-4) << kelvin;
    for (int c = 0; c < 3; ++c)
      EXPECT_GE(rgb[c], 0);
    EXPECT_LE(rgb.x, red * (1 + 1e-6)) << kelvin; // ever less red, ever more blue
    EXPECT_GE(rgb.z, blue * (1 - 1e-6)) << kelvin;
    red = rgb.x;
    blue = rgb.z;
  }
}

TEST(Blackbody, LuminanceTableFollowsPlanck) {
  for (double kelvin = 505; kelvin < 50000; kelvin *= 1.013)
    EXPECT_NEAR(blackbody_luminance(kelvin, 1500) * planck_xyz(1500).y / planck_xyz(kelvin).y, 1,
                1e-4)
        << kelvin;
  EXPECT_NEAR(blackbody_luminance(1500, 1500), 1, 1e-12);
}

TEST(Blackbody, LuminanceBeyondTheTable) {
  EXPECT_EQ(blackbody_luminance(0, 1500), 0);
  EXPECT_EQ(blackbody_luminance(-5, 1500), 0);
  EXPECT_EQ(blackbody_luminance(1e-30, 1500), 0);
  // Wien: the logarithm is linear in 1 / T.
  EXPECT_NEAR(std::log(blackbody_luminance(400, 1500)) /
                  std::log(planck_xyz(400).y / planck_xyz(1500).y),
              1, 0.01);
  // Rayleigh and Jeans: proportional to T.
  EXPECT_NEAR(blackbody_luminance(4e6, 2e6), 2, 1e-9);
  EXPECT_TRUE(std::isfinite(blackbody_luminance(1e300, 100)));
}

} // namespace
} // namespace vdbeam
