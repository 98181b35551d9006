// Edges of the medium are seen by several rays of a pixel, which changes no mean.
#include "rays/uneven_pixels.h"

#include "estimators/beam/beam.h"
#include "rays/tile_rays.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

using namespace test;

/// A picture of 32 x 32 pixels, a medium of even opacity at a distance of 5.
struct Picture {
  PassImage image;
  Camera camera;

  Picture() : camera(settings(), {32, 32}, {}) {
    image.resize(32, 32);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        set(x, y, 0.8f, 5);
  }
  static CameraSettings settings() {
    CameraSettings settings;
    settings.position = {0, 0, 5};
    settings.look_at = {0, 0, 0};
    settings.fov = 30; // a pixel is 0.084 wide at a distance of 5
    return settings;
  }
  void set(int x, int y, float opacity, float distance) {
    const auto pixel = static_cast<std::size_t>(y * 32 + x);
    image.opacity[pixel] = opacity;
    image.depth[pixel] = opacity * distance;
  }
  bool uneven(int x, int y) const {
    const SeenMedium seen{
        0, 0, image.width, image.height, image.opacity.data(), image.depth.data()};
    return is_uneven(seen, camera, 1, x, y);
  }
};

TEST(UnevenPixels, LieBesideEdgesOfOpacityAndDepth) {
  Picture picture;
  EXPECT_FALSE(picture.uneven(8, 8));
  picture.set(9, 8, 0.4f, 5);
  EXPECT_TRUE(picture.uneven(8, 8));
  EXPECT_FALSE(picture.uneven(7, 8));
  picture.set(9, 8, 0.8f, 5.6f); // seven pixels behind the others
  EXPECT_FALSE(picture.uneven(8, 8));
  picture.set(9, 8, 0.8f, 5.8f); // nine
  EXPECT_TRUE(picture.uneven(8, 8));
  picture.set(9, 8, 0, 0);
  EXPECT_TRUE(picture.uneven(8, 8));
}

/// Or a pixel's value would decide how much it counts. Nor are pixels of other tiles looked at,
/// which other threads may be filling.
TEST(UnevenPixels, AreJudgedByTheOthersOfTheirTile) {
  Picture picture;
  picture.set(8, 8, 0, 0);
  EXPECT_FALSE(picture.uneven(8, 8));
  picture.set(16, 8, 0, 0);
  EXPECT_FALSE(picture.uneven(15, 8));
  EXPECT_TRUE(picture.uneven(17, 8));
}

/// Light of a tile's pixels on a surface, as a function of x and y.
struct Lit {
  std::vector<EndOfRay> ends;
  std::vector<float> nothing;

  template <class Value>
  explicit Lit(const Value& value) : ends(256), nothing(256) {
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        ends[static_cast<std::size_t>(y * 16 + x)] = {static_cast<float>(value(x, y)), true};
  }
  bool uneven(int x, int y) const {
    return is_unevenly_lit({0, 0, 16, 16, nothing.data(), nothing.data()}, ends.data(), x, y);
  }
};

TEST(UnevenPixels, LieBesideEdgesOfLight) {
  const Lit shadow([](int x, int) { return x < 8 ? 1 : 0.1; });
  const Lit slanted([](int x, int y) { return x + y / 2 < 10 ? 1 : 0.1; });
  const Lit faint([](int x, int) { return x < 8 ? 1 : 0.8; });
  const Lit gradient([](int x, int) { return 1 + 0.05 * x; });
  EXPECT_TRUE(shadow.uneven(7, 5));
  EXPECT_TRUE(shadow.uneven(8, 5));
  EXPECT_TRUE(shadow.uneven(8, 0)); // at the border of the tile
  EXPECT_FALSE(shadow.uneven(5, 5));
  EXPECT_TRUE(slanted.uneven(7, 5));
  EXPECT_FALSE(faint.uneven(8, 5));
  EXPECT_FALSE(gradient.uneven(8, 5));
  EXPECT_FALSE(Lit([](int, int) { return 0; }).uneven(8, 5));
  Lit own = faint;
  own.ends[5 * 16 + 8].light = 100;
  EXPECT_FALSE(own.uneven(8, 5));
}

/// A surface that no pixel shows must cost nothing. What a pixel itself shows must not decide.
TEST(UnevenPixels, LieBesideSurfaces) {
  Lit sky([](int x, int) { return x < 8 ? 1 : 0.1; });
  for (EndOfRay& end : sky.ends)
    end.surface = false;
  EXPECT_FALSE(sky.uneven(8, 5));
  sky.ends[5 * 16 + 8].surface = true;
  EXPECT_FALSE(sky.uneven(8, 5));
  EXPECT_TRUE(sky.uneven(7, 5));
}

/// As that of an area lamp by one shadow ray for each pixel: more rays everywhere would not pay.
TEST(UnevenPixels, AreNotMadeByNoise) {
  Rng rng({}, RngStage::test, 1);
  int uneven = 0, pixels = 0;
  for (int tile = 0; tile < 100; ++tile) {
    const Lit half_lit([&](int, int) { return rng.uniform() < 0.5f ? 1 : 0.2; });
    for (int y = 1; y < 15; ++y)
      for (int x = 1; x < 15; ++x, ++pixels)
        uneven += half_lit.uneven(x, y);
  }
  EXPECT_LT(uneven, 0.1 * pixels);
}

/// A dense ball with a sharp rim before a bright sky.
MemoryScene dense_ball() {
  MemoryScene scene;
  const Vec3<int> cells{4, 4, 4};
  const auto density = [](int i, int j, int k) {
    const double x = i - 16, y = j - 16, z = k - 16;
    return x * x + y * y + z * z < 150 ? 1.0 : 0.0;
  };
  scene.add(closed_field(cells, density), box_map(cells, Vec3d(-0.5), Vec3d(0.5))).extinction = 200;
  scene.add_light(LightType::distant).direction = {1, -0.4, -0.5};
  scene.add_light(LightType::environment).radiance = Rgb(1);
  scene.look({0.5, 0.6, 2.5}, {0, 0, 0}, 24, 32, 32);
  scene.scene.render.photons = 200; // nothing that is tested depends on them
  return scene;
}

/// Where a ray passes the picture, relative to the first modulo 1.
std::array<double, 2> offset(const Camera& camera, const TileRays::PixelRay& ray,
                             const TileRays::PixelRay& first) {
  const auto place = [&](const TileRays::PixelRay& one) {
    return camera.project(one.eye.origin + one.eye.direction).value();
  };
  const std::array<double, 2> a = place(ray), b = place(first);
  const auto apart = [](double d) { return d - std::floor(d); };
  return {apart(a[0] - b[0]), apart(a[1] - b[1])};
}

TEST(TileRays, RaysOfARefinedPixelLieOnALattice) {
  const TestFrame frame(dense_ball());
  const EstimatorInput input = frame.input();
  TileRays rays;
  rays.prepare(input, {1, 1, 0}, 16, 16);
  EXPECT_TRUE(rays.more(37).empty());
  rays.refine(input, {1, 1, 0}, 37);
  ASSERT_EQ(rays.more(37).size(), std::size_t{3});
  EXPECT_TRUE(rays.more(36).empty());
  constexpr double expected[3][2] = {{0.5, 0.25}, {0.75, 0.5}, {0.25, 0.75}};
  for (std::size_t i = 0; i < 3; ++i) {
    const TileRays::PixelRay& ray = rays.more(37)[i];
    EXPECT_EQ(ray.pixel, rays[37].pixel);
    EXPECT_NE(ray.stream, rays[37].stream);
    const std::array<double, 2> at = offset(input.camera, ray, rays[37]);
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double off = std::abs(at[axis] - expected[i][axis]);
      EXPECT_LT(std::min(off, 1 - off), 1e-6) << i;
    }
  }
  rays.prepare(input, {1, 1, 0}, 0, 16);
  EXPECT_TRUE(rays.more(37).empty());
}

/// Opacity, depth and what is seen of the sky, which no photon changes, with and without.
TEST(UnevenPixels, KeepTheirMeansAndLoseNoise) {
  const MemoryScene scene = dense_ball();
  constexpr int passes = 48;
  const PassMeans fine = render_passes(scene, EstimatorType::gather, passes);
  const PassMeans coarse = render_passes(scene, EstimatorType::beam, passes);
  EXPECT_GT(fine.statistics.camera_rays, coarse.statistics.camera_rays);
  EXPECT_LT(fine.statistics.camera_rays, 3 * coarse.statistics.camera_rays);
  const auto compare = [](const Samples& a, const Samples& b) {
    EXPECT_LT(std::abs(a.mean() - b.mean()), 4.5 * std::hypot(a.error(), b.error()));
    EXPECT_LT(a.error(), 0.6 * b.error()); // a third of the variance
  };
  compare(fine.opacity, coarse.opacity);
  compare(fine.depth, coarse.depth);
  compare(fine.background[0], coarse.background[0]);
}

} // namespace
} // namespace vdbeam
