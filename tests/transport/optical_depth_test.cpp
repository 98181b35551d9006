#include "medium/optical_depth.h"

#include "math/sampling.h"
#include "medium/depth_profile.h"
#include "support/exact_field.h"
#include "support/memory_scene.h"
#include "support/statistics.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::ExactField;

constexpr float voxel = 1.0f / 32;
const Vec3<int> cells{4, 3, 5};

using Value = std::function<double(int, int, int)>;

/// A volume of 32 x 24 x 40 voxels about the origin, and its oracle.
struct Subject {
  Subject(const Value& value, float extinction)
      : exact(cells, value),
        medium(test::make_medium(one_volume(value, extinction), {Vec3f(-0.7f), Vec3f(0.7f)})) {}

  static std::vector<Volume> one_volume(const Value& value, float extinction) {
    std::vector<Volume> volumes;
    volumes.push_back(
        test::make_volume(test::closed_field(cells, value), voxel, corner(), extinction));
    return volumes;
  }
  static Vec3f corner() { return Vec3f(-0.5f, -0.375f, -0.625f); }

  /// Optical depth from 0 to t_end, in double precision.
  double tau(const Ray& ray, double t_end) const {
    const Vec3d o = (Vec3d(ray.origin) - Vec3d(corner())) * 32.0, d = Vec3d(ray.direction) * 32.0;
    return static_cast<double>(medium.volumes[0].extinction) * exact.integral(o, d, 0, t_end);
  }

  ExactField exact;
  Medium medium;
};

Value constant_medium() {
  return [](int, int, int) { return 0.7; };
}
Value linear_medium() {
  return [](int i, int j, int k) { return 0.02 * i + 0.01 * j + 0.005 * k; };
}
Value random_medium() {
  return [](int i, int j, int k) { return test::lattice_noise(i, j, k); };
}
/// A few dense voxels in nothing, and large empty and uniform parts.
Value sparse_medium() {
  return [](int i, int j, int k) {
    if (i < 16)
      return k < 16 ? 0.0 : 0.5;
    return test::lattice_noise(i, j, k) < 0.05 ? 3.0 : 0.0;
  };
}

std::vector<std::pair<const char*, Value>> all_media() {
  return {{"constant", constant_medium()},
          {"linear", linear_medium()},
          {"random", random_medium()},
          {"sparse", sparse_medium()}};
}

Ray random_ray(Rng& rng) {
  const Vec3f target{rng.uniform() - 0.5f, 0.75f * rng.uniform() - 0.375f,
                     1.25f * rng.uniform() - 0.625f};
  const Vec3f d = sample_sphere(rng.uniform(), rng.uniform());
  return {target - d * (1.2f * rng.uniform()), d};
}

TEST(OpticalDepth, ExactTransmittanceIsTheIntegral) {
  for (const auto& [name, value] : all_media()) {
    SCOPED_TRACE(name);
    const Subject subject(value, 8);
    Rng rng({1, 0, 0}, RngStage::test, 1);
    for (int i = 0; i < 300; ++i) {
      const Ray ray = random_ray(rng);
      const float t_end = i % 2 ? 3.0f : rng.uniform();
      const double expected = std::exp(-subject.tau(ray, static_cast<double>(t_end)));
      ASSERT_NEAR(exact_transmittance(subject.medium, {ray, 0, t_end}).x, expected,
                  1e-4 * expected);
    }
  }
}

TEST(OpticalDepth, RaysAlongLatticePlanesAndThroughLatticePoints) {
  const Subject subject(random_medium(), 8);
  for (int axis = 0; axis < 3; ++axis)
    for (int plane = 1; plane < 24; ++plane)
      for (const bool diagonal : {false, true}) {
        Vec3f o = Subject::corner() + Vec3f(static_cast<float>(plane) * voxel), d(0);
        d[axis] = plane % 2 ? 1.0f : -1.0f;
        if (diagonal)
          d[(axis + 1) % 3] = 1;
        d = normalize(d);
        const Ray ray{o - d * 0.25f, d};
        // The border planes themselves belong to both sides, so the ray ends inside.
        const double expected = std::exp(-subject.tau(ray, 0.25 + 1.0 / 64));
        ASSERT_NEAR(exact_transmittance(subject.medium, {ray, 0, 0.25f + 1.0f / 64}).x, expected,
                    1e-4 * expected);
      }
}

TEST(OpticalDepth, SegmentsAreContiguousAndSumToTheWhole) {
  const Subject subject(sparse_medium(), 8);
  Rng rng({1, 0, 0}, RngStage::test, 2);
  for (int i = 0; i < 200; ++i) {
    const Ray ray = random_ray(rng);
    double sum = 0;
    float before = 0;
    for_each_piece(subject.medium.volumes[0], {ray, 0, 3}, [&](float t_a, float t_b, float tau) {
      EXPECT_GE(t_a, before);
      EXPECT_GE(t_b, t_a);
      EXPECT_GE(tau, 0);
      before = t_b;
      sum += static_cast<double>(tau);
      return true;
    });
    ASSERT_NEAR(sum, subject.tau(ray, 3), 1e-4);
  }
}

TEST(DepthProfile, KnotsLieOnTheIntegral) {
  for (const auto& [name, value] : all_media()) {
    SCOPED_TRACE(name);
    const Subject subject(value, 8);
    Rng rng({1, 0, 0}, RngStage::test, 3);
    DepthProfile profile;
    for (int i = 0; i < 150; ++i) {
      const Ray ray = random_ray(rng);
      profile.build(subject.medium, {ray, 0, 3}, 1e-6f);
      if (profile.empty()) {
        ASSERT_NEAR(subject.tau(ray, 3), 0, 1e-6);
        continue;
      }
      for (std::size_t knot = 0; knot < profile.knots(); ++knot) {
        const double expected = std::exp(-subject.tau(ray, static_cast<double>(profile.t(knot))));
        ASSERT_NEAR(std::exp(-profile.tau(knot)), expected, 1e-4 * expected);
      }
      const double end = subject.tau(ray, 3);
      if (end < 13.8) {
        ASSERT_NEAR(profile.tau(profile.knots() - 1), end, 1e-4);
      } else {
        ASSERT_GT(profile.tau(profile.knots() - 1), 13.8);
      }
    }
  }
}

TEST(DepthProfile, CursorInterpolatesAndHoldsItsEnds) {
  const Subject subject(constant_medium(), 8);
  const Ray ray{{-1, 0.01f, 0.02f}, {1, 0, 0}};
  DepthProfile profile;
  profile.build(subject.medium, {ray, 0, 3}, 1e-6f);
  ProfileCursor cursor(profile);
  for (const double t : {0.1, 0.5, 0.62, 0.9, 1.3, 1.5, 2.0}) {
    cursor.move_to(static_cast<float>(t));
    EXPECT_NEAR(cursor.tau(), 0.7 * 8 * std::clamp(t - 0.5, 0.0, 1.0), 1e-4) << t;
  }
}

TEST(DepthProfile, DepthIsTheMeanOfTheFirstCollision) {
  const Subject subject(constant_medium(), 8);
  DepthProfile profile;
  profile.build(subject.medium, {{{-1, 0.01f, 0.02f}, {1, 0, 0}}, 0, 3}, 1e-6f);
  const double s = 0.7 * 8, end = std::exp(-s);
  EXPECT_NEAR(profile.opacity_depth(subject.medium), 0.5 * (1 - end) + (1 - end) / s - end, 2e-4);
}

/// Two volumes that overlap in part, on lattices of different origin and size, both chromatic.
struct Overlap {
  Overlap() {
    std::vector<Volume> volumes;
    volumes.push_back(
        test::make_volume(test::closed_field({2, 2, 2}, first), 0.05f, Vec3f(-0.6f), 6));
    volumes.push_back(
        test::make_volume(test::closed_field({2, 2, 2}, second), 0.04f, Vec3f(-0.2f), 5));
    volumes[0].channel_scale = {1, 0.5f, 0.2f};
    volumes[1].channel_scale = {0, 1, 0.7f};
    medium = test::make_medium(std::move(volumes), {Vec3f(-0.7f), Vec3f(0.7f)});
  }
  static double first(int i, int j, int k) { return test::lattice_noise(i, j, k, 5); }
  static double second(int i, int j, int k) { return test::lattice_noise(i, j, k, 6); }

  Vec3d tau(const Ray& ray, double t_end) const {
    const ExactField a({2, 2, 2}, first), b({2, 2, 2}, second);
    const Vec3d o(ray.origin), d(ray.direction);
    const double voxel_a = static_cast<double>(0.05f), voxel_b = static_cast<double>(0.04f);
    const double tau_a = 6 * a.integral((o + Vec3d(0.6)) / voxel_a, d / voxel_a, 0, t_end);
    const double tau_b = 5 * b.integral((o + Vec3d(0.2)) / voxel_b, d / voxel_b, 0, t_end);
    Vec3d sum;
    for (int c = 0; c < 3; ++c)
      sum[c] = static_cast<double>(medium.volumes[0].channel_scale[c]) * tau_a +
               static_cast<double>(medium.volumes[1].channel_scale[c]) * tau_b;
    return sum;
  }

  Medium medium;
};

TEST(OpticalDepth, OverlappingChromaticVolumesAdd) {
  const Overlap overlap;
  Rng rng({1, 0, 0}, RngStage::test, 4);
  DepthProfile profile;
  for (int i = 0; i < 200; ++i) {
    const Ray ray = random_ray(rng);
    const Vec3d tau = overlap.tau(ray, 3);
    const Rgb tr = exact_transmittance(overlap.medium, {ray, 0, 3});
    profile.build(overlap.medium, {ray, 0, 3}, 1e-9f);
    for (int c = 0; c < 3; ++c) {
      const double expected = std::exp(-tau[c]);
      ASSERT_NEAR(tr[c], expected, 1e-4 * expected);
      const double seen =
          profile.empty()
              ? 0
              : static_cast<double>(profile.channels(overlap.medium, profile.knots() - 1)[c]);
      ASSERT_NEAR(std::exp(-seen), expected, 1e-4 * expected);
    }
    for (std::size_t knot = 0; knot < profile.knots(); knot += 7) {
      const Vec3d at = overlap.tau(ray, static_cast<double>(profile.t(knot)));
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(profile.channels(overlap.medium, knot)[c], at[c], 1e-4);
    }
  }
}

/// With u in the middle of n equal steps the mean over u is a quadrature of a function that falls
/// from exp(-3) or less to 0 once.
TEST(TransmittanceEstimate, MeanIsTheTransmittance) {
  const Subject random(random_medium(), 12);
  const Overlap overlap;
  Rng rng({1, 0, 0}, RngStage::test, 9);
  constexpr int steps = 4096;
  int ended = 0;
  for (int i = 0; i < 60; ++i) {
    const Ray ray = random_ray(rng);
    const Medium& medium = i % 2 == 0 ? random.medium : overlap.medium;
    const Rgb exact = exact_transmittance(medium, {ray, 0, 3});
    Vec3d mean;
    for (int n = 0; n < steps; ++n) {
      const float u = (static_cast<float>(n) + 0.5f) / steps;
      const Rgb tr = estimate_transmittance(medium, {ray, 0, 3}, u);
      ended += max_component(tr) == 0;
      for (int c = 0; c < 3; ++c)
        mean[c] += static_cast<double>(tr[c]) / steps;
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean[c], static_cast<double>(exact[c]),
                  std::exp(-3.0) / steps + 1e-5 * static_cast<double>(exact[c]));
  }
  EXPECT_GT(ended, 0);
}

Rgb ratio_transmittance(const Medium& medium, const Ray& ray, float t_end, Rng& rng) {
  RatioTracking tracking(medium, {ray, 0, t_end});
  while (tracking.advance(rng) && tracking.attenuate(rng)) {
  }
  return tracking.transmittance();
}

TEST(RatioTracking, MeanIsTheTransmittance) {
  const Subject random(random_medium(), 6), sparse(sparse_medium(), 6);
  const Overlap overlap;
  Rng ray_rng({1, 0, 0}, RngStage::test, 5), rng({1, 0, 0}, RngStage::test, 6);
  for (int i = 0; i < 24; ++i) {
    const Ray ray = random_ray(ray_rng);
    const float t_end = i % 3 == 2 ? 0.6f : 3.0f;
    const Medium& medium = i % 3 == 0 ? random.medium : i % 3 == 1 ? sparse.medium : overlap.medium;
    const Rgb exact = exact_transmittance(medium, {ray, 0, t_end});
    test::Samples samples[3];
    for (int n = 0; n < 40000; ++n) {
      const Rgb tr = ratio_transmittance(medium, ray, t_end, rng);
      for (int c = 0; c < 3; ++c)
        samples[c].add(static_cast<double>(tr[c]));
    }
    for (int c = 0; c < 3; ++c)
      test::expect_mean(samples[c], static_cast<double>(exact[c]), 0, 2e-6);
  }
}

} // namespace
} // namespace vdbeam
