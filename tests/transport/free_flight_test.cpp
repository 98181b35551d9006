#include "math/sampling.h"
#include "medium/optical_depth.h"
#include "medium/scattering.h"
#include "support/chi_squared.h"
#include "support/exact_field.h"
#include "support/memory_scene.h"
#include "support/next_scattering.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr int free_flights = 100000;
constexpr int free_bins = 60;

/// Chi-squared p-value of the distances (and of no collision at all) that delta tracking draws
/// along a ray, against the exact CDF.
double flight_p_value(const Medium& medium, const Ray& ray, float t_end, std::uint64_t seed) {
  std::vector<double> counts(free_bins + 1), expected(free_bins + 1);
  double before = 1;
  for (int b = 0; b < free_bins; ++b) {
    const double after = static_cast<double>(
        exact_transmittance(medium, {ray, 0, t_end * static_cast<float>(b + 1) / free_bins}).x);
    expected[static_cast<std::size_t>(b)] = (before - after) * free_flights;
    before = after;
  }
  expected[free_bins] = before * free_flights;
  Rng rng({seed, 0, 0}, RngStage::test, 1);
  for (int n = 0; n < free_flights; ++n) {
    Rgb weight(1);
    const Collision hit = test::next_scattering(medium, ray, weight, rng);
    const bool beyond = hit.volume == nullptr || hit.t >= t_end;
    ++counts[beyond ? free_bins : static_cast<std::size_t>(hit.t / t_end * free_bins)];
  }
  return test::chi_squared_test(counts, expected);
}

Volume noise_volume(std::uint64_t seed, float voxel, float corner, float extinction) {
  return test::make_volume(test::closed_field({3, 3, 3},
                                              [seed](int i, int j, int k) {
                                                const double u = test::lattice_noise(i, j, k, seed);
                                                return k > 12 && i < 8 ? 0.0 : u * u;
                                              }),
                           voxel, Vec3f(corner), extinction);
}

const Boxf free_bounds{Vec3f(-0.6f), Vec3f(0.6f)};

/// Rays across the box (-0.5, 0.5)^3.
std::vector<Ray> rays(int count) {
  std::vector<Ray> result{{{-0.7f, 0.03f, 0.011f}, {1, 0, 0}},
                          {{0.1f, 0.1f, 0.1f}, normalize(Vec3f(-1, 2, 0.5f))}};
  Rng rng({1, 0, 0}, RngStage::test, 2);
  while (static_cast<int>(result.size()) < count) {
    const Vec3f d = sample_sphere(rng.uniform(), rng.uniform());
    result.push_back({Vec3f(rng.uniform() - 0.5f) * 0.5f - d * 0.6f, d});
  }
  return result;
}

void expect_exact_flights(std::vector<Volume> volumes, int ray_count) {
  const Medium medium = test::make_medium(std::move(volumes), free_bounds);
  std::uint64_t seed = 1;
  for (const Ray& ray : rays(ray_count))
    EXPECT_GT(flight_p_value(medium, ray, 1.5f, seed++), test::family_level(3 * ray_count));
}

TEST(DeltaTracking, HomogeneousFlightsAreExponential) {
  std::vector<Volume> volumes;
  volumes.push_back(
      test::make_volume(test::uniform_field({2, 2, 2}, 1), 1.0f / 16, Vec3f(-0.5f), 4));
  expect_exact_flights(std::move(volumes), 4);
}

TEST(DeltaTracking, HeterogeneousFlightsFollowTheIntegral) {
  std::vector<Volume> volumes;
  volumes.push_back(noise_volume(3, 1.0f / 24, -0.5f, 12));
  expect_exact_flights(std::move(volumes), 6);
}

TEST(DeltaTracking, OverlappingVolumesSuperpose) {
  std::vector<Volume> volumes;
  volumes.push_back(noise_volume(3, 1.0f / 24, -0.5f, 8));
  volumes.push_back(noise_volume(4, 1.0f / 40, -0.25f, 10));
  volumes.push_back(test::make_volume(test::uniform_field({1, 1, 1}, 1), 0.05f, Vec3f(0), 2));
  expect_exact_flights(std::move(volumes), 6);
}

/// Which of the overlapping volumes scatters must follow their sigma_t at the point.
TEST(DeltaTracking, CollisionsBelongToVolumesByTheirShare) {
  std::vector<Volume> volumes;
  volumes.push_back(
      test::make_volume(test::uniform_field({2, 2, 2}, 1), 1.0f / 16, Vec3f(-0.5f), 3));
  volumes.push_back(
      test::make_volume(test::uniform_field({1, 1, 1}, 1), 1.0f / 8, Vec3f(-0.5f), 1));
  const Medium medium = test::make_medium(std::move(volumes), free_bounds);
  Rng rng({1, 0, 0}, RngStage::test, 3);
  double counts[2] = {0, 0};
  for (int n = 0; n < free_flights; ++n) {
    Rgb weight(1);
    const Collision hit = test::next_scattering(medium, {{-0.7f, 0, 0}, {1, 0, 0}}, weight, rng);
    if (hit.volume != nullptr)
      ++counts[hit.volume == &medium.volumes[1]];
  }
  const double total = counts[0] + counts[1];
  EXPECT_GT(test::chi_squared_test({counts[0], counts[1]}, {0.75 * total, 0.25 * total}), 1e-4);
}

/// Spectral tracking: the weight of what passes is Tr per channel, and the weight of what collides
/// before t is 1 - Tr(t) per channel, whatever the ray brought along.
TEST(SpectralTracking, WeightsAreUnbiasedInEveryChannel) {
  std::vector<Volume> volumes;
  volumes.push_back(noise_volume(3, 1.0f / 24, -0.5f, 12));
  volumes.push_back(noise_volume(4, 1.0f / 40, -0.25f, 10));
  volumes[0].channel_scale = {1, 0.4f, 0.1f};
  volumes[1].channel_scale = {0, 0.3f, 1};
  const Medium medium = test::make_medium(std::move(volumes), free_bounds);
  ASSERT_TRUE(medium.chromatic);
  const Rgb start{0.5f, 1, 0.25f};
  Rng rng({1, 0, 0}, RngStage::test, 4);
  for (const Ray& ray : rays(5)) {
    test::Samples passed[3], collided[3];
    float largest = 0;
    for (int n = 0; n < free_flights; ++n) {
      Rgb weight = start;
      const Collision hit = test::next_scattering(medium, ray, weight, rng);
      for (int c = 0; c < 3; ++c) {
        const double w = static_cast<double>(weight[c]);
        passed[c].add(hit.volume == nullptr ? w : 0);
        collided[c].add(hit.volume != nullptr && hit.t < 0.6f ? w : 0);
      }
      largest = std::max(largest, max_component(weight));
    }
    const Rgb all = exact_transmittance(medium, {ray});
    const Rgb part = exact_transmittance(medium, {ray, 0, 0.6f});
    for (int c = 0; c < 3; ++c) {
      test::expect_mean(passed[c], static_cast<double>(start[c] * all[c]), 0, 2e-6);
      test::expect_mean(collided[c], static_cast<double>(start[c] * (1 - part[c])), 0, 2e-6);
    }
    EXPECT_LT(largest, 3 * (start.x + start.y + start.z)); // history-aware: bounded
  }
}

TEST(Scattering, RouletteKeepsTheMean) {
  Rng rng({1, 0, 0}, RngStage::test, 5);
  const Rgb albedo{0.9f, 0.5f, 0.1f}, start{0.2f, 1, 2};
  test::Samples absorbed[3], roulette[3];
  for (int n = 0; n < 200000; ++n) {
    Rgb a = start, b = start * 0.02f;
    const bool a_lives = absorption_roulette(albedo, a, rng);
    const bool b_lives = survive_roulette(0.1f, b, rng);
    for (int c = 0; c < 3; ++c) {
      absorbed[c].add(a_lives ? static_cast<double>(a[c]) : 0);
      roulette[c].add(b_lives ? static_cast<double>(b[c]) : 0);
    }
  }
  for (int c = 0; c < 3; ++c) {
    test::expect_mean(absorbed[c], static_cast<double>(start[c] * albedo[c]));
    test::expect_mean(roulette[c], static_cast<double>(start[c] * 0.02f));
  }
  Rgb black = start;
  EXPECT_FALSE(absorption_roulette(Rgb(0), black, rng));
}

} // namespace
} // namespace vdbeam
