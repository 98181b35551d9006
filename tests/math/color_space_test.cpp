#include "vdbeam/color_space.h"

#include "volume/blackbody.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr ColorSpace all[] = {ColorSpace::rec709, ColorSpace::rec2020, ColorSpace::acescg,
                              ColorSpace::aces2065_1};

ColorMatrix between(ColorSpace from, ColorSpace to) {
  return rgb_matrix(chromaticities_of(from), chromaticities_of(to));
}

/// ITU-R BT.2087-0, equation for linear BT.709 to BT.2020; and linear sRGB to ACEScg and
/// ACES2065-1 as the ACES configurations of OpenColorIO have it, rounded.
TEST(ColorSpaces, MatricesAreThePublishedOnes) {
  const auto expect_near = [](const ColorMatrix& m, const double(&rows)[9], double tolerance) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(m.red[i], rows[i], tolerance);
      EXPECT_NEAR(m.green[i], rows[3 + i], tolerance);
      EXPECT_NEAR(m.blue[i], rows[6 + i], tolerance);
    }
  };
  expect_near(between(ColorSpace::rec709, ColorSpace::rec2020),
              {0.6274, 0.3293, 0.0433, 0.0691, 0.9195, 0.0114, 0.0164, 0.0880, 0.8956}, 1e-4);
  expect_near(between(ColorSpace::rec709, ColorSpace::acescg),
              {0.6131, 0.3395, 0.0474, 0.0702, 0.9164, 0.0134, 0.0206, 0.1096, 0.8698}, 2e-4);
  expect_near(between(ColorSpace::rec709, ColorSpace::aces2065_1),
              {0.4396, 0.3830, 0.1774, 0.0898, 0.8134, 0.0968, 0.0175, 0.1115, 0.8710}, 2e-4);
}

TEST(ColorSpaces, WhiteStaysWhiteAndTheWayBackIsTheInverse) {
  for (const ColorSpace a : all)
    for (const ColorSpace b : all) {
      const Vec3d white = between(a, b).apply({1, 1, 1});
      const Vec3d color = between(b, a).apply(between(a, b).apply({0.2, 0.7, 0.05}));
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(white[i], 1, 1e-12);
        EXPECT_NEAR(color[i], Vec3d(0.2, 0.7, 0.05)[i], 1e-12);
      }
    }
}

/// The colour of a glowing body, taken back to XYZ, is Planck's, also where Rec.709 cannot show it.
TEST(ColorSpaces, BlackBodiesAreOnThePlanckianLocus) {
  for (const ColorSpace space : {ColorSpace::acescg, ColorSpace::aces2065_1, ColorSpace::rec2020})
    for (const double kelvin : {1200.0, 2000.0, 6500.0}) {
      const Vec3d rgb = between(space, ColorSpace::rec709).apply(blackbody_color(kelvin, space));
      const Vec3d xyz = planck_xyz(kelvin), expected = xyz_to_rgb(xyz / xyz.y);
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(rgb[i], expected[i], 2e-4 * max_component(expected)) << kelvin;
    }
  EXPECT_LT(xyz_to_rgb(planck_xyz(1200)).z, 0) << "Rec.709 shows it, and the test shows nothing";
}

} // namespace
} // namespace vdbeam
