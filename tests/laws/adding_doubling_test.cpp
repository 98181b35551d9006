#include "laws/adding_doubling.h"
#include "laws/slab_tables.h"

#include <gtest/gtest.h>

// The reference solution that renders are compared with must itself reproduce what is published.
namespace vdbeam::slab {
namespace {

constexpr double pi = std::numbers::pi;

void expect_digits(double value, double published, double relative) {
  EXPECT_NEAR(value, published, relative * published);
}

TEST(AddingDoubling, IsotropicSlabsOfVanDeHulst) {
  for (const IsotropicSlab& published : isotropic_slabs) {
    SCOPED_TRACE(testing::Message() << "b " << published.thickness << " a " << published.albedo);
    // The published radiances carry the error of 8 points, so they are compared on the same points.
    const Slab slab(isotropic(), published.albedo, published.thickness, {0.1}, {0.1, 0.5, 1}, 8);
    if (published.beam) {
      expect_digits(pi * slab.reflectance(), published.up, 1e-5);
      EXPECT_NEAR(pi * (slab.transmittance() - slab.direct()), published.down,
                  5e-6 * published.down + 1e-9);
    } else {
      expect_digits(pi * slab.diffuse_reflectance(), published.up, 1e-5);
      expect_digits(pi * slab.diffuse_transmittance(), published.down, 1e-5);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double irradiance = pi / 0.1;
      expect_digits(published.beam ? irradiance * slab.reflected_radiance(i)
                                   : slab.reflected_of_diffuse(i),
                    published.radiance_up[i], 1e-5);
      expect_digits(published.beam ? irradiance * slab.transmitted_radiance(i)
                                   : slab.transmitted_of_diffuse(i),
                    published.radiance_down[i], published.radiance_down[i] < 1e-10 ? 1e-3 : 1e-5);
    }
  }
}

TEST(AddingDoubling, RayleighSlabsOfSweigart) {
  for (const RayleighSlab& published : rayleigh_slabs) {
    SCOPED_TRACE(testing::Message() << "b " << published.thickness << " a " << published.albedo);
    const Slab slab(rayleigh(), published.albedo, published.thickness, {rayleigh_mu0}, {}, 8);
    const double flux = pi * rayleigh_mu0;
    expect_digits(flux * slab.reflectance(), published.up, 1e-5);
    expect_digits(flux * (slab.transmittance() - slab.direct()), published.down, 1e-4);
  }
}

TEST(AddingDoubling, HenyeyGreensteinSlabsOfVanDeHulst) {
  for (const HenyeyGreensteinSlab& published : henyey_greenstein_slabs) {
    const Slab slab(henyey_greenstein(0.75), 1, published.thickness);
    expect_digits(pi * slab.reflectance(), published.up, 5e-5);
    expect_digits(pi * (slab.transmittance() - slab.direct()), published.down, 5e-5);
  }
  const Slab tissue(henyey_greenstein(0.75), 0.9, 2);
  EXPECT_NEAR(tissue.reflectance(), tissue_reflectance, 1e-5);
  EXPECT_NEAR(tissue.transmittance(), tissue_transmittance, 1e-5);
}

TEST(AddingDoubling, HFunctionOfChandrasekhar) {
  for (std::size_t i = 0; i < h_conservative.size(); ++i)
    EXPECT_NEAR(h_function(1, 0.1 * static_cast<double>(i + 1)), h_conservative[i], 6e-5);
}

// A half space reflects 1 - sqrt(1 - a) H(mu0) of a beam, and sends back the radiance
// a mu0 H(mu) H(mu0) / (4 pi (mu + mu0)) per irradiance (Chandrasekhar 1960, section 47).
TEST(AddingDoubling, HalfSpaceFollowsTheHFunction) {
  for (const double albedo : {0.5, 0.9, 0.99}) {
    const double mu0 = 0.3, mu = 0.7;
    const Slab slab(isotropic(), albedo, 200, {mu0}, {mu});
    EXPECT_NEAR(slab.reflectance(), 1 - std::sqrt(1 - albedo) * h_function(albedo, mu0), 1e-6);
    expect_digits(slab.reflected_radiance(0),
                  albedo * mu0 / (4 * pi * (mu + mu0)) * h_function(albedo, mu) *
                      h_function(albedo, mu0),
                  1e-6);
  }
}

TEST(AddingDoubling, LosesNothingWhereNothingIsAbsorbed) {
  for (const double g : {-0.5, 0.0, 0.75})
    for (const double thickness : {0.1, 1.0, 100.0}) {
      const Slab slab(henyey_greenstein(g), 1, thickness, {1, 0.4});
      EXPECT_NEAR(slab.reflectance(0) + slab.transmittance(0), 1, 1e-7);
      EXPECT_NEAR(slab.reflectance(1) + slab.transmittance(1), 1, 1e-7);
      EXPECT_NEAR(slab.diffuse_reflectance() + slab.diffuse_transmittance(), 1, 1e-7);
    }
}

TEST(AddingDoubling, QuadratureHasConverged) {
  const Slab coarse(henyey_greenstein(0.75), 0.99, 4, {0.5}, {0.8}, 32);
  const Slab fine(henyey_greenstein(0.75), 0.99, 4, {0.5}, {0.8}, 48);
  expect_digits(coarse.reflectance(), fine.reflectance(), 1e-6);
  expect_digits(coarse.transmittance(), fine.transmittance(), 1e-6);
  expect_digits(coarse.reflected_radiance(0), fine.reflected_radiance(0), 1e-5);
}

} // namespace
} // namespace vdbeam::slab
