#include "photonmap/photon_map.h"
#include "photons/clear_kernel.h"

#include "photonmap/query_cases.h"

#include <tbb/global_control.h>

namespace vdbeam {
namespace {

/// Uniform photons of total power 1 in the unit cube about the origin.
PhotonList cube_photons(std::size_t count, bool directions = false, std::uint64_t seed = 1) {
  Rng rng({}, RngStage::test, seed);
  PhotonList photons;
  for (std::size_t i = 0; i < count; ++i) {
    photons.position.push_back(oracle::random_point(rng) * 0.5f);
    photons.power.push_back(Rgb(1.0f, 2.0f, 0.5f) * (1 / static_cast<float>(count)));
    if (directions)
      photons.direction.push_back(sample_sphere(rng.uniform(), rng.uniform()));
  }
  return photons;
}

const std::vector<PhaseFunction>& isotropic() {
  static const std::vector<PhaseFunction> phases(1);
  return phases;
}

/// A ray through the middle of the cube sees 1 photon per unit area and length, so its estimate is
/// the integral of the weights, 1, over 4 pi. With n kernel-weighted photons the relative standard
/// error is sqrt(pi integral k^2 / n): 1 for the constant kernel, 9/5 the variance for the
/// biweight, 16/5 for the fourth-order one. Photons share rays, so 5 standard errors of one ray are
/// granted.
TEST(PhotonMap, UniformPhotonsGiveTheirDensity) {
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight}) {
    RadiusSettings radii;
    radii.neighbours = 200;
    const PhotonMap map = PhotonMap::build(cube_photons(40000), 1, radii, shape);
    const std::vector<float> weights(9, 1.25f);
    PhotonMap::RayProfile profile;
    profile.t_begin = 1.6f; // 0.4 to each side of the middle
    profile.step = 0.1f;
    profile.knots = 9;
    profile.weights = weights.data();
    profile.phases = &isotropic();
    for (const Vec3f& direction : {Vec3f{0, 0, 1}, {1, 0, 0}, {0, -0.6f, 0.8f}}) {
      profile.ray = {direction * -2.0f, direction};
      Rgb radiance(0);
      const QueryCounts counts = map.query_ray(profile, radiance);
      EXPECT_GT(counts.contributions, 500u);
      EXPECT_NEAR(radiance.x * 4 * pi, 1,
                  5 * std::sqrt(3.2 / static_cast<double>(counts.contributions)));
    }
    Rgb scattered;
    map.query_point({0, 0, 0}, {0, 0, 1}, 0, isotropic(), &scattered);
    EXPECT_NEAR(scattered.x * 4 * pi, 1, 5 * std::sqrt(4.0 / 200));
  }
}

/// Every other photon keeps half of its kernel, the rest all of it.
void check_resized(const PhotonList& photons, float factor) {
  const auto share = [](const Vec3f& photon, std::size_t, float radius) {
    return Kernel{radius, 1, photon.x > 0 ? 1 : 1 - radius};
  };
  const auto build = [&](float radius) {
    RadiusSettings radii;
    radii.mode = KernelRadius::fixed;
    radii.fixed_radius = radius;
    return PhotonMap::build(photons, 1, radii, KernelShape::biweight);
  };
  PhotonMap own = build(0.5f), own_alone = build(0.5f), resized_alone = build(0.5f * factor);
  PhotonMap resized = own.resized(factor);
  resized.fit(share);
  own.fit(share);
  own_alone.fit(share);
  resized_alone.fit(share);
  EXPECT_FLOAT_EQ(resized.mean_radius(), resized_alone.mean_radius());
  const std::vector<float> weights(2, 1);
  PhotonMap::RayProfile profile;
  profile.step = 4;
  profile.knots = 2;
  profile.weights = weights.data();
  profile.phases = &isotropic();
  for (int i = 0; i < 100; ++i) {
    profile.ray = {{-1 + 0.02f * static_cast<float>(i), 0.1f, -2}, {0, 0, 1}};
    const auto query = [&](const PhotonMap& map) {
      Rgb radiance;
      map.query_ray(profile, radiance);
      return radiance.x;
    };
    EXPECT_EQ(query(own), query(own_alone));
    EXPECT_NEAR(query(resized), query(resized_alone), 1e-5f * query(resized_alone));
  }
}

TEST(PhotonMap, ResizedKernelsHaveTheirOwnShares) {
  const PhotonList photons = cube_photons(2000);
  check_resized(photons, 0.5f);
  check_resized(photons, 1.4f);
}

/// One photon's kernel, scanned by parallel rays, integrates to its power times weight and phase.
TEST(PhotonMap, KernelConservesPower) {
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::epanechnikov, KernelShape::biweight}) {
    PhotonList photons;
    photons.position.push_back({0.3f, -0.2f, 0.1f});
    photons.power.push_back(Rgb(3));
    RadiusSettings radii;
    radii.mode = KernelRadius::fixed;
    radii.fixed_radius = 0.5f;
    const PhotonMap map = PhotonMap::build(photons, 1, radii, shape);
    const float weights[2] = {2, 2};
    PhotonMap::RayProfile profile;
    profile.step = 4;
    profile.knots = 2;
    profile.weights = weights;
    profile.phases = &isotropic();
    double sum = 0;
    constexpr int n = 200;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        profile.ray = {{-0.3f + 1.2f * (static_cast<float>(i) + 0.5f) / n,
                        -0.8f + 1.2f * (static_cast<float>(j) + 0.5f) / n, -2},
                       {0, 0, 1}};
        Rgb radiance(0);
        map.query_ray(profile, radiance);
        sum += radiance.x * (1.2 / n) * (1.2 / n);
      }
    EXPECT_NEAR(sum * 4 * M_PI, 6, 0.02) << static_cast<int>(shape);
  }
}

TEST(PhotonMap, ThreadsDoNotChangeABit) {
  const std::vector<PhaseFunction> phases{oracle::henyey_greenstein(0.7)};
  std::vector<float> first;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    RadiusSettings radii;
    radii.neighbours = 150;
    const PhotonMap map =
        PhotonMap::build(cube_photons(60000, true), 3, radii, KernelShape::biweight);
    BeamTile tile = oracle::cube_tile(phases);
    map.query(tile);
    if (first.empty())
      first = tile.radiance;
    EXPECT_EQ(tile.radiance, first);
  }
}

TEST(PhotonMap, TargetsAgree) {
  const std::vector<PhaseFunction> phases{oracle::henyey_greenstein(0.7)};
  RadiusSettings radii;
  const PhotonMap map =
      PhotonMap::build(cube_photons(20000, true), 1, radii, KernelShape::biweight);
  BeamTile first = oracle::cube_tile(phases);
  map.query(first);
  oracle::on_every_target([&] {
    BeamTile tile = oracle::cube_tile(phases);
    map.query(tile);
    for (std::size_t r = 0; r < BeamTile::ray_count; ++r)
      EXPECT_NEAR(tile.radiance[r], first.radiance[r], 2e-5 * first.radiance[r]);
  });
}

/// The query adds; it does not replace.
TEST(PhotonMap, QueriesAdd) {
  const PhotonMap map = PhotonMap::build(cube_photons(3000), 1, {}, KernelShape::biweight);
  BeamTile once = oracle::cube_tile(isotropic()), twice = oracle::cube_tile(isotropic());
  map.query(once);
  map.query(twice);
  map.query(twice);
  for (std::size_t r = 0; r < BeamTile::ray_count; ++r)
    EXPECT_FLOAT_EQ(twice.radiance[r], 2 * once.radiance[r]);
}

/// All kinds of query on a map; every result finite, contributions or not.
void expect_finite(const PhotonMap& map) {
  BeamTile tile = oracle::cube_tile(isotropic());
  map.query(tile);
  for (const float value : tile.radiance)
    ASSERT_TRUE(std::isfinite(value));
  const float weights[2] = {1, 1};
  PhotonMap::RayProfile profile;
  profile.ray = {{0, 0, -2}, {0, 0, 1}};
  profile.step = 4;
  profile.knots = 2;
  profile.weights = weights;
  profile.phases = &isotropic();
  Rgb radiance(0), scattered(0);
  map.query_ray(profile, radiance);
  map.query_point({0, 0, 0}, {0, 0, 1}, 0, isotropic(), &scattered);
  for (int c = 0; c < 3; ++c)
    ASSERT_TRUE(std::isfinite(radiance[c]) && std::isfinite(scattered[c]));
}

TEST(PhotonMapLimits, DegenerateSets) {
  Rng rng({}, RngStage::test, 4);
  const std::function<Vec3f()> makers[] = {
      [] { return Vec3f(0); }, // at one point
      [&] {
        return Vec3f{1, 2, 3} * (rng.uniform() - 0.5f);
      }, // on a line
      [&] {
        return Vec3f{0, 0, rng.uniform() - 0.5f};
      }, // on the ray
      [&] {
        return Vec3f{rng.uniform() - 0.5f, 0, rng.uniform()};
      }, // on a plane
      [&] { return oracle::random_point(rng) * 1e6f; },
      [&] { return oracle::random_point(rng) * 1e-6f; },
      [&] {
        return Vec3f{1e6f, 1e6f, 1e6f} + oracle::random_point(rng);
      }};
  for (const auto& make : makers)
    for (const std::size_t count : {1u, 15u, 16u, 17u, 129u, 5000u})
      for (const float neighbours : {1.0f, 100.0f, 10000.0f}) {
        PhotonList photons;
        for (std::size_t i = 0; i < count; ++i) {
          photons.position.push_back(make());
          photons.power.push_back(Rgb(1));
        }
        RadiusSettings radii;
        radii.neighbours = neighbours;
        const PhotonMap map = PhotonMap::build(photons, 1, radii, KernelShape::biweight);
        EXPECT_EQ(map.size(), count);
        EXPECT_GT(map.mean_radius(), 0);
        expect_finite(map);
      }
}

TEST(PhotonMapLimits, NoPhotons) {
  const PhotonMap map = PhotonMap::build({}, 3, {}, KernelShape::biweight);
  EXPECT_EQ(map.size(), 0u);
  EXPECT_TRUE(map.bounds().empty());
  expect_finite(map);
  expect_finite(PhotonMap());
}

/// A kernel far larger than everything: each photon counts on each ray.
TEST(PhotonMapLimits, KernelLargerThanTheVolume) {
  RadiusSettings radii;
  radii.mode = KernelRadius::fixed;
  radii.fixed_radius = 100;
  const PhotonMap map = PhotonMap::build(cube_photons(500), 1, radii, KernelShape::constant);
  BeamTile tile = oracle::cube_tile(isotropic());
  for (float& w : tile.weights)
    w = 1;
  const QueryCounts counts = map.query(tile);
  EXPECT_EQ(counts.contributions, 500u * BeamTile::ray_count);
  for (std::size_t r = 0; r < BeamTile::ray_count; ++r)
    EXPECT_NEAR(tile.radiance[r] * 4 * pi * pi * 1e4f, 1, 1e-3);
}

TEST(PhotonMapLimits, NonFinitePhotonsAreDropped) {
  PhotonList photons = cube_photons(100, true);
  photons.position[3].x = infinity;
  photons.position[40].z = 1e20f;
  photons.direction[7].y = std::numeric_limits<float>::quiet_NaN();
  photons.power[9].z = -infinity;
  const PhotonMap map = PhotonMap::build(photons, 3, {}, KernelShape::biweight);
  EXPECT_EQ(map.size(), 96u);
  expect_finite(map);
}

/// Weights that are zero, denormal, or missing; rays without direction; a step of zero.
TEST(PhotonMapLimits, OddTiles) {
  const PhotonMap map = PhotonMap::build(cube_photons(3000), 1, {}, KernelShape::biweight);
  BeamTile tile = oracle::cube_tile(isotropic());
  for (float& w : tile.weights)
    w = 1e-42f;
  tile.profiles[3].knots = 0;
  tile.profiles[4].knots = 1;
  tile.profiles[5].step = 0;
  for (int r = 96; r < 112; ++r)
    tile.du[r] = tile.dv[r] = tile.dw[r] = 0;
  tile.du[130] = tile.dv[130] = tile.dw[130] = 0;
  map.query(tile);
  for (std::size_t r = 0; r < BeamTile::ray_count; ++r) {
    ASSERT_TRUE(std::isfinite(tile.radiance[r]));
    if ((r >= 48 && r < 112) || r == 130)
      EXPECT_EQ(tile.radiance[r], 0);
    else
      EXPECT_GT(tile.radiance[r], 0);
  }
  BeamTile dark = oracle::cube_tile(isotropic());
  std::fill(dark.weights.begin(), dark.weights.end(), 0.0f);
  EXPECT_EQ(map.query(dark).candidates, 0u);
}

/// Before a wall at z = 0.5 no kernel reaches it, and what is far from it does not change. All that
/// photons bring stays the same, up to what those at the wall count more or less.
TEST(PhotonMap, KernelsKeepClearOfSurfaces) {
  RadiusSettings radii;
  radii.mode = KernelRadius::fixed;
  radii.fixed_radius = 0.1f;
  PhotonMap map = PhotonMap::build(cube_photons(20000), 1, radii, KernelShape::biweight);
  const auto before_wall = [](const Vec3f& p, std::size_t, float radius) {
    return clear_kernel(radius, std::abs(p.z - 0.5f));
  };
  const auto gathered = [&](float z, float cosine) {
    Rgb sum;
    const Vec3f direction{std::sqrt(1 - cosine * cosine), 0, cosine};
    std::vector<PhaseFunction> phases(1);
    map.query_point({0.5f, 0.5f, z}, direction, 0, phases, &sum);
    return sum.x;
  };
  const float far = gathered(0.1f, 1), near = gathered(0.45f, 1);
  map.fit(before_wall);
  EXPECT_EQ(gathered(0.1f, 1), far);
  EXPECT_NEAR(gathered(0.45f, 1), near, 0.5f * near);
  EXPECT_EQ(gathered(0.5f, 1), 0);
}

/// Nobody waits for the map of a pass that is stopped: on two processors its kernels took up to a
/// second.
TEST(PhotonMap, StopsWhereItIsAsked) {
  const std::atomic<bool> request = true;
  const StopToken stop(&request);
  EXPECT_EQ(PhotonMap::build(cube_photons(20000), 1, {}, KernelShape::biweight, &stop).size(), 0u);
  PhotonMap map = PhotonMap::build(cube_photons(20000), 1, {}, KernelShape::biweight);
  const float radius = map.mean_radius();
  std::atomic<int> fitted = 0;
  map.fit([&](const Vec3f&, std::size_t, float) { return ++fitted, Kernel{2 * radius}; }, &stop);
  EXPECT_EQ(fitted, 0);
  EXPECT_EQ(map.mean_radius(), radius);
}

/// What the memory budget of 55 bytes per photon counts on.
TEST(PhotonMap, BytesPerPhoton) {
  const PhotonMap grey = PhotonMap::build(cube_photons(50000, true), 1, {}, KernelShape::biweight);
  EXPECT_LE(grey.bytes(), 35u * 50000);
  const PhotonMap colour =
      PhotonMap::build(cube_photons(50000, true), 3, {}, KernelShape::biweight);
  EXPECT_LE(colour.bytes(), 43u * 50000);
}

} // namespace
} // namespace vdbeam
