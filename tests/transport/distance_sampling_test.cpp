#include "medium/distance_sampling.h"

#include "math/sampling.h"
#include "support/exact_field.h"
#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::ExactField;
using Value = std::function<double(int, int, int)>;

constexpr float voxel = 1.0f / 16;
const Boxf bounds{Vec3f(-0.7f), Vec3f(0.7f)};

Volume volume_of(const Value& value, float corner, float extinction, const Rgb& albedo,
                 const Rgb& scale = Rgb(1)) {
  Volume volume =
      test::make_volume(test::closed_field({2, 2, 2}, value), voxel, Vec3f(corner), extinction);
  volume.albedo = albedo;
  volume.channel_scale = scale;
  return volume;
}

/// One volume of a medium, for the oracle.
struct Part {
  Value value;
  double corner;
};

/// Integral of sigma_s Tr of volume v in channel c, by fine steps in double precision.
std::vector<Vec3d> exact_scattering(const Medium& medium, const std::vector<Part>& parts,
                                    const Ray& ray) {
  const Vec3d d = Vec3d(ray.direction) * 16.0;
  std::vector<ExactField> fields;
  std::vector<Vec3d> origins;
  std::vector<double> t;
  for (const Part& part : parts) {
    fields.emplace_back(Vec3<int>{2, 2, 2}, part.value);
    origins.push_back((Vec3d(ray.origin) - Vec3d(part.corner)) * 16.0);
    const std::vector<double> more = fields.back().crossings(origins.back(), d, 0, 3);
    t.insert(t.end(), more.begin(), more.end());
  }
  std::sort(t.begin(), t.end());
  std::vector<Vec3d> sums(parts.size());
  Vec3d tau;
  constexpr int steps = 100;
  for (std::size_t piece = 0; piece + 1 < t.size(); ++piece)
    for (int i = 0; i < steps; ++i) {
      const double dt = (t[piece + 1] - t[piece]) / steps, at = t[piece] + (i + 0.5) * dt;
      std::vector<Vec3d> sigma(parts.size());
      Vec3d total;
      for (std::size_t v = 0; v < parts.size(); ++v) {
        sigma[v] = Vec3d(medium.volumes[v].channel_scale) *
                   (fields[v].density(origins[v] + d * at) *
                    static_cast<double>(medium.volumes[v].extinction));
        total += sigma[v];
      }
      for (int c = 0; c < 3; ++c)
        for (std::size_t v = 0; v < parts.size(); ++v)
          if (total[c] > 0)
            sums[v][c] += static_cast<double>(medium.volumes[v].albedo[c]) * sigma[v][c] /
                          total[c] * std::exp(-tau[c]) * -std::expm1(-total[c] * dt);
      tau += total * dt;
    }
  return sums;
}

/// Compares the mean weights with the exact integrals, and bounds the spread of a draw.
void expect_unbiased(const Medium& medium, const std::vector<Part>& parts, double spread_limit) {
  Rng ray_rng({1, 0, 0}, RngStage::test, 1), rng({1, 0, 0}, RngStage::test, 2);
  DepthProfile profile;
  for (int i = 0; i < 12; ++i) {
    const Vec3f d = sample_sphere(ray_rng.uniform(), ray_rng.uniform());
    const Ray ray{Vec3f(ray_rng.uniform() - 0.5f) * 0.5f - d * (i % 3 == 0 ? 0.1f : 0.9f), d};
    profile.build(medium, {ray, 0, 3}, 1e-7f);
    ASSERT_FALSE(profile.empty());
    DistanceSampler sampler(medium, ray, profile);
    std::vector<std::array<test::Samples, 3>> samples(parts.size());
    for (int n = 0; n < 30000; ++n) {
      const int c = medium.chromatic ? std::min(2, static_cast<int>(rng.uniform() * 3)) : 0;
      const ScatterPoint point = sampler.sample(rng.uniform(), c);
      for (std::size_t v = 0; v < parts.size(); ++v)
        for (int k = 0; k < 3; ++k)
          samples[v][static_cast<std::size_t>(k)].add(static_cast<double>((*point.weights)[v][k]));
    }
    const std::vector<Vec3d> exact = exact_scattering(medium, parts, ray);
    for (std::size_t v = 0; v < parts.size(); ++v)
      for (std::size_t c = 0; c < 3; ++c) {
        test::expect_mean(samples[v][c], exact[v][static_cast<int>(c)], 0, 1e-4);
        if (parts.size() == 1) {
          EXPECT_LT(std::sqrt(samples[v][c].variance()),
                    spread_limit * samples[v][c].mean() + 1e-6);
        }
      }
  }
}

double noise(int i, int j, int k) {
  return test::lattice_noise(i, j, k);
}
double other_noise(int i, int j, int k) {
  const double u = test::lattice_noise(i, j, k, 2);
  return u * u * u;
}

Medium one(const Value& value, float extinction, const Rgb& scale = Rgb(1)) {
  std::vector<Volume> volumes;
  volumes.push_back(volume_of(value, -0.5f, extinction, {0.9f, 0.7f, 0.3f}, scale));
  return test::make_medium(std::move(volumes), bounds);
}

TEST(DistanceSampler, MeanWeightIsTheScatteredShare) {
  expect_unbiased(one(noise, 3), {{noise, -0.5}}, 0.3);
}

TEST(DistanceSampler, ChromaticExtinction) {
  expect_unbiased(one(noise, 5, {1, 0.3f, 0.02f}), {{noise, -0.5}}, 1.5);
}

// One voxel is optically thick here: within a lattice cube optical depth is far from linear.
TEST(DistanceSampler, OpticallyThickVoxels) {
  expect_unbiased(one(noise, 300), {{noise, -0.5}}, 1);
}

TEST(DistanceSampler, RampsOfOpticallyThickVoxels) {
  const Value ramp = [](int i, int j, int k) { return i % 4 == 2 && j > 0 && k > 0 ? 1.0 : 0.0; };
  expect_unbiased(one(ramp, 1600), {{ramp, -0.5}}, 1);
}

TEST(DistanceSampler, OverlappingVolumesShare) {
  std::vector<Volume> volumes;
  volumes.push_back(volume_of(noise, -0.5f, 10, {0.9f, 0.7f, 0.3f}));
  volumes.push_back(volume_of(other_noise, -0.47f, 12, {1, 1, 0.1f}));
  expect_unbiased(test::make_medium(std::move(volumes), bounds),
                  {{noise, -0.5}, {other_noise, static_cast<double>(-0.47f)}}, 1);
}

TEST(DistanceSampler, OverlappingChromaticVolumesShare) {
  std::vector<Volume> volumes;
  volumes.push_back(volume_of(noise, -0.5f, 30, {0.9f, 0.7f, 0.3f}, {1, 0.2f, 0}));
  volumes.push_back(volume_of(other_noise, -0.33f, 40, {1, 1, 0.1f}, {0.1f, 0.5f, 1}));
  expect_unbiased(test::make_medium(std::move(volumes), bounds),
                  {{noise, -0.5}, {other_noise, static_cast<double>(-0.33f)}}, 1);
}

// Stratified numbers in [0, 1) round to 1. A profile may end in pieces without medium: nothing can
// be drawn there, and a density of 0 would make the weights of multiple importance sampling 0 / 0.
TEST(DistanceSampler, DrawsOfZeroAndOneLieInTheMedium) {
  const Value between_air = [](int i, int, int) { return i >= 5 && i <= 9 ? 1.0 : 0.0; };
  const Rgb grey(1), coloured{1, 0.5f, 0.1f};
  for (const Rgb& scale : {grey, coloured}) {
    const Medium medium = one(between_air, 30, scale);
    const Ray ray{{-1, 0.03f, 0.01f}, {1, 0, 0}};
    DepthProfile profile;
    profile.build(medium, {ray, 0, 3}, 1e-7f);
    const std::size_t last = profile.knots() - 1;
    ASSERT_GT(last, 2U);
    ASSERT_EQ(profile.total(last), profile.total(last - 1)) << "the profile must end in air";
    DistanceSampler sampler(medium, ray, profile);
    for (const float u : {0.0f, std::nextafter(1.0f, 0.0f), 1.0f}) {
      const ScatterPoint point = sampler.sample(u, 0);
      EXPECT_GT(point.pdf, 0) << "u = " << u;
      EXPECT_GE(point.position.x, -0.5f + 4 * voxel) << "u = " << u;
      EXPECT_LE(point.position.x, -0.5f + 10 * voxel) << "u = " << u;
    }
  }
}

} // namespace
} // namespace vdbeam
