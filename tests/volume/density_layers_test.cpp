// Fields whose density changes along y alone, and what rays are spared in them.
#include "volume/density_layers.h"

#include "math/sampling.h"
#include "medium/optical_depth.h"
#include "support/exact_field.h"
#include "support/make_field.h"
#include "support/memory_scene.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

const Vec3<int> cells{3, 3, 2};

/// Like cells at each height, with the values of `value(y)`.
DensityField layered_field(const std::function<double(int)>& value) {
  std::vector<std::int32_t> table;
  std::vector<float> bricks;
  for (int x = 0; x < cells.x; ++x)
    for (int y = 0; y < cells.y; ++y)
      for (int z = 0; z < cells.z; ++z)
        table.push_back(y);
  for (int cell = 0; cell < cells.y; ++cell)
    for (int x = 0; x < brick_width; ++x)
      for (int y = 0; y < brick_width; ++y)
        for (int z = 0; z < brick_width; ++z)
          bricks.push_back(static_cast<float>(value(cell_width * cell + y)));
  return DensityField({}, cells, std::move(table), std::move(bricks), {});
}

double bumpy(int y) {
  return y % 5 == 0 ? 0 : test::lattice_noise(0, y, 0);
}

Ray random_ray(Rng& rng, int kind) {
  const Vec3f through{24 * rng.uniform(), 24 * rng.uniform(), 16 * rng.uniform()};
  Vec3f d = sample_sphere(rng.uniform(), rng.uniform());
  if (kind == 1) // along the layers
    d.y = 0;
  if (kind == 2) // nearly so
    d.y *= 1e-5f;
  if (kind == 3) // across
    d = {0, d.y > 0 ? 1.0f : -1.0f, 0};
  d = normalize(d);
  return {through - d * (30 * rng.uniform()), d};
}

TEST(DensityLayers, OpticalDepthIsTheIntegral) {
  const Volume volume = test::make_volume(layered_field(bumpy), 1, Vec3f(0), 0.5f);
  ASSERT_NE(volume.field.layers(), nullptr);
  const test::ExactField exact(cells, [](int, int y, int) { return bumpy(y); });
  Rng rng({}, RngStage::test, 1);
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = random_ray(rng, i % 4);
    const float t_end = i % 3 ? 60.0f : 60 * rng.uniform();
    const double expected = 0.5 * exact.integral(Vec3d(ray.origin), Vec3d(ray.direction), 0,
                                                 static_cast<double>(t_end));
    const LayeredSegment part(volume, {ray, 0, t_end});
    ASSERT_NEAR(part.optical_depth(), expected, 2e-5 * (1 + expected));
    double sum = 0;
    float before = 0;
    for_each_piece(volume, {ray, 0, t_end}, [&](float t_a, float t_b, float tau) {
      EXPECT_GE(t_a, before);
      EXPECT_GT(t_b, t_a);
      EXPECT_GE(tau, 0);
      before = t_b;
      sum += static_cast<double>(tau);
      return true;
    });
    ASSERT_NEAR(sum, expected, 2e-5 * (1 + expected));
  }
}

TEST(DensityLayers, PiecesEndWhenTheVisitorSaysSo) {
  const Volume volume = test::make_volume(layered_field(bumpy), 1, Vec3f(0), 0.5f);
  int visits = 0;
  for_each_piece(volume, {{{12, -1, 8}, {0, 1, 0}}, 0, 60},
                 [&](float, float, float) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

TEST(DensityLayers, AnyOtherChangeOfDensityIsSeen) {
  EXPECT_EQ(DensityField().layers(), nullptr);
  // One value of one brick, a cell that differs, and a face between layers.
  std::vector<float> brick(DensityField::brick_size, 1);
  EXPECT_NE(DensityField({}, {1, 1, 1}, {0}, brick, {}).layers(), nullptr);
  brick[500] = 2;
  EXPECT_EQ(DensityField({}, {1, 1, 1}, {0}, brick, {}).layers(), nullptr);
  EXPECT_EQ(DensityField({}, {2, 1, 1}, {-2, -1}, {}, {1}).layers(), nullptr);
  EXPECT_EQ(DensityField({}, {1, 2, 1}, {-2, -1}, {}, {1}).layers(), nullptr);
  EXPECT_NE(DensityField({}, {1, 2, 1}, {-2, -2}, {}, {1}).layers(), nullptr);
}

TEST(DensityLayers, FollowALimitOfValues) {
  DensityField field = layered_field([](int y) { return y; });
  ASSERT_GT(field.limit_values(3), 0);
  const Volume volume = test::make_volume(std::move(field), 1, Vec3f(0), 1);
  const LayeredSegment up(volume, {{{12, -1, 8}, {0, 1, 0}}, 0, 60});
  EXPECT_NEAR(up.optical_depth(), 4.5 + 21 * 3, 1e-4);
}

} // namespace
} // namespace vdbeam
