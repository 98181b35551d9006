#include "math/rng.h"
#include "math/sampling.h"
#include "support/chi_squared.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

TEST(Sampling, FrameIsOrthonormalAndRightHanded) {
  std::vector<Vec3f> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}};
  normals.push_back(normalize(Vec3f{1e-4f, -1e-4f, -1}));
  normals.push_back(normalize(Vec3f{1, 1, -1e-7f}));
  Rng rng({}, RngStage::test, 0);
  for (int i = 0; i < 1000; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    normals.push_back(sample_sphere(u, v));
  }
  for (const Vec3f& n : normals) {
    Vec3f t, b;
    orthonormal_frame(n, t, b);
    EXPECT_NEAR(dot(t, t), 1, 2e-6);
    EXPECT_NEAR(dot(b, b), 1, 2e-6);
    EXPECT_NEAR(dot(t, b), 0, 1e-6);
    EXPECT_NEAR(dot(t, n), 0, 1e-6);
    EXPECT_NEAR(length(cross(t, b) - n), 0, 2e-6);
  }
}

TEST(Sampling, DirectionAboutKeepsTheAngle) {
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 1000; ++i) {
    const float u = rng.uniform(), v = rng.uniform(), cosine = 2 * rng.uniform() - 1;
    const Vec3f axis = sample_sphere(u, v), d = direction_about(axis, cosine, 6 * v);
    EXPECT_NEAR(dot(axis, d), cosine, 1e-6);
    EXPECT_NEAR(length(d), 1, 1e-6);
  }
}

TEST(Sampling, SphereIsUniform) {
  constexpr int rows = 12, columns = 24, samples = 200000;
  std::vector<double> counts(rows * columns, 0.0),
      expected(rows * columns, double(samples) / (rows * columns));
  Rng rng({}, RngStage::test, 2);
  for (int i = 0; i < samples; ++i) {
    const float u = rng.uniform(), v = rng.uniform();
    const Vec3f d = sample_sphere(u, v);
    EXPECT_NEAR(length(d), 1, 1e-6);
    const int row = std::min(rows - 1, static_cast<int>((d.x + 1) / 2 * rows)); // another axis
    const float turn = std::atan2(d.y, d.z) / (2 * pi) + 0.5f;
    counts[row * columns + std::min(columns - 1, static_cast<int>(turn * columns))] += 1;
  }
  EXPECT_GT(test::chi_squared_test(counts, expected), 1e-3);
}

} // namespace
} // namespace vdbeam
