#include "math/rng.h"
#include "photonmap/photon_map.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

/// Uniform photons of power 1 / n in the unit cube: a ray through the middle sees 1 photon per unit
/// area and length, so its estimate is the integral of the weights, 1, over 4 pi.
TEST(PhotonMap, UniformPhotonsGiveTheirDensity) {
  Rng rng({}, RngStage::test, 1);
  PhotonList photons;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    photons.position.push_back({rng.uniform(), rng.uniform(), rng.uniform()});
    photons.power.push_back(Rgb(1.0f / n));
  }
  RadiusSettings radii;
  const PhotonMap map = PhotonMap::build(photons, 1, radii, KernelShape::biweight);
  const std::vector<PhaseFunction> phases(1);
  const std::vector<float> weights(11, 1.0f);
  PhotonMap::RayProfile profile;
  profile.ray = {{0.5f, 0.5f, -1}, {0, 0, 1}};
  profile.t_begin = 1;
  profile.step = 0.1f;
  profile.knots = 11;
  profile.weights = weights.data();
  profile.phases = &phases;
  Rgb radiance(0);
  const QueryCounts counts = map.query_ray(profile, radiance);
  // About 20000 pi r^2 photons with r = 0.106; the biweight's variance is 9/5 of the constant's.
  EXPECT_GT(counts.contributions, 500u);
  EXPECT_NEAR(radiance.x * 4 * pi, 1, 4 * std::sqrt(1.8f / 700));
}

} // namespace
} // namespace vdbeam
