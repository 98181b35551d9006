#include "lights/entry_sampler.h"
#include "lights/light_test_scene.h"

namespace vdbeam {
namespace {

using namespace test;

// Area of a union's silhouette by casting a fine grid of lines.
double silhouette(const std::vector<Parallelepiped>& boxes, const Vec3f& direction) {
  Vec3f x, y;
  orthonormal_frame(direction, x, y);
  constexpr int n = 800;
  constexpr double half = 2.0;
  int hits = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const auto at = [&](int k) { return static_cast<float>(half * (2 * (k + 0.5) / n - 1)); };
      const Ray ray{x * at(i) + y * at(j) - direction * 10.0f, direction};
      for (const Parallelepiped& box : boxes)
        if (chord(box, ray) > 0) {
          ++hits;
          break;
        }
    }
  return hits * (2 * half / n) * (2 * half / n);
}

TEST(EntrySampler, MeanWeightIsTheUnionsSilhouette) {
  const std::vector<Parallelepiped> boxes{cube({}, 0.9f), skew_box(),
                                          cube({0.3f, 0.3f, 0.2f}, 0.4f)};
  const EntrySampler sampler(boxes);
  for (const Vec3f& direction : {Vec3f{0, 0, 1}, normalize(Vec3f{1, 2, -0.5f})}) {
    Average weight;
    Rng rng({}, RngStage::test, 1);
    for (int i = 0; i < 30000; ++i) {
      const float u_face = rng.uniform(), u = rng.uniform(), v = rng.uniform();
      const EntrySampler::Entry entry = sampler.sample_line(direction, u_face, u, v);
      weight.add(static_cast<double>(entry.weight));
      // No box lies behind the entry, and one begins there.
      double behind = 0, ahead = 0;
      for (const Parallelepiped& box : boxes) {
        behind = std::max(behind, chord(box, {entry.point - direction * 2e-5f, -direction}));
        ahead = std::max(ahead, chord(box, {entry.point - direction * 2e-5f, direction}));
      }
      EXPECT_LT(behind, 1e-4);
      EXPECT_GT(ahead, 0);
    }
    const double expected = silhouette(boxes, direction);
    EXPECT_NEAR(weight.mean(), expected, 4.5 * weight.error() + 3e-3 * expected);
  }
}

TEST(EntrySampler, SurfaceOfOneBoxHasConstantWeight) {
  const Parallelepiped box = make_box({}, {2, 0, 0}, {0, 3, 0}, {0, 0, 0.5f});
  const EntrySampler sampler({box});
  const float surface = 2 * (6 + 1 + 1.5f);
  EXPECT_FLOAT_EQ(sampler.surface_area(), surface);
  Rng rng({}, RngStage::test, 2);
  for (int i = 0; i < 1000; ++i) {
    const float a = rng.uniform(), b = rng.uniform(), c = rng.uniform(), d = rng.uniform(),
                e = rng.uniform();
    EXPECT_FLOAT_EQ(sampler.sample_surface(a, b, c, d, e).weight, pi * surface);
  }
}

TEST(EntrySampler, EveryFaceIsReached) {
  const EntrySampler sampler({cube({}, 1)});
  int seen[3][2] = {};
  Rng rng({}, RngStage::test, 3);
  for (int i = 0; i < 6000; ++i) {
    const float a = rng.uniform(), b = rng.uniform(), c = rng.uniform(), d = rng.uniform(),
                e = rng.uniform();
    const EntrySampler::Entry entry = sampler.sample_surface(a, b, c, d, e);
    for (int k = 0; k < 3; ++k)
      if (std::abs(std::abs(entry.point[k]) - 0.5f) < 1e-6f) {
        ++seen[k][entry.point[k] > 0];
        EXPECT_LE(entry.point[k] * entry.direction[k], 0);
      }
  }
  for (const auto& axis : seen)
    for (const int count : axis)
      EXPECT_NEAR(count, 1000, 150);
}

TEST(EntrySampler, FlatAndMissingBoxesGiveNothing) {
  const EntrySampler flat({make_box({}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0})}), none({});
  for (const EntrySampler& sampler : {flat, none}) {
    EXPECT_EQ(sampler.surface_area(), 0);
    EXPECT_EQ(sampler.sample_line({0, 0, 1}, 0.5f, 0.5f, 0.5f).weight, 0);
    EXPECT_EQ(sampler.sample_surface(0.5f, 0.5f, 0.5f, 0.5f, 0.5f).weight, 0);
  }
}

} // namespace
} // namespace vdbeam
