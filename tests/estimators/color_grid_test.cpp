#include "support/memory_scene.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

// Colours that multiply the albedo.
namespace vdbeam {
namespace {

using test::MemoryScene;
using test::PassMeans;

/// A box of 16^3 voxels from -1/2 to 1/2 in front of a camera that looks along -z.
MemoryScene box(const Rgb& albedo) {
  MemoryScene scene;
  const Vec3<int> cells{2, 2, 2};
  VolumeSettings& volume = scene.add(test::closed_field(cells, [](int, int, int) { return 1; }),
                                     test::box_map(cells, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = 4;
  volume.albedo = albedo;
  scene.look({0, 0, 4}, {0, 0, 0}, 20, 16, 16);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, 0, -1};
  scene.scene.render.photons = 20000;
  scene.scene.render.neighbours = 30;
  return scene;
}

template <class Color>
void paint(MemoryScene& scene, Color color) {
  scene.scene.volumes[0].color_grid = "memory";
  DensityGrid& grid = scene.grids[0];
  grid.color = std::make_shared<const ColorField>(grid.field, color);
}

/// A constant colour is an albedo: with `path` to the last bit. With `beam` photons are sent
/// elsewhere, since their powers are another measure of what they bring: the same mean.
TEST(ColorGrid, AConstantColorIsAnAlbedo) {
  const Rgb color{0.75f, 0.5f, 0.25f};
  MemoryScene painted = box(Rgb(1));
  paint(painted, [&](const Vec3d&) { return color; });
  for (const EstimatorType type :
       {EstimatorType::path, EstimatorType::beam, EstimatorType::march}) {
    SCOPED_TRACE(type.name);
    const int passes = type == EstimatorType::path ? 48 : 8;
    const PassMeans a = test::render_passes(box(color), type, passes),
                    b = test::render_passes(painted, type, passes);
    double difference = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        difference += std::abs(static_cast<double>(a.pixels[i][c] - b.pixels[i][c]));
    if (type == EstimatorType::path) {
      EXPECT_EQ(difference, 0);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      test::expect_same_mean(a.total[c], b.total[c], 0.003 * a.total[c].mean());
      EXPECT_LT(b.total[c].error(), 0.01 * b.total[c].mean()); // or it would prove little
    }
  }
}

/// Light that is scattered once has the colour of the place where that was, not a mean: the sun
/// shines along the view, so each pixel sees one column of the box, and its direct light is that of
/// a white box times the colour there.
TEST(ColorGrid, SingleScatteringHasTheColorOfItsPlace) {
  MemoryScene white = box(Rgb(1)), painted = box(Rgb(1));
  paint(painted, [](const Vec3d& local) {
    return local.x < 8 ? Rgb{1, 0.25f, 0} : Rgb{0, 0.25f, 1};
  });
  for (const EstimatorType type : {EstimatorType::path, EstimatorType::beam, EstimatorType::march})
    for (const DirectLight direct : {DirectLight::automatic, DirectLight::photons}) {
      SCOPED_TRACE(type.name);
      for (MemoryScene* scene : {&white, &painted}) {
        scene->scene.render.max_bounces = 1;
        scene->scene.render.direct = direct;
      }
      const PassMeans a = test::render_passes(white, type, 8),
                      b = test::render_passes(painted, type, 8);
      const auto pixel = [](int x, int y) { return static_cast<std::size_t>(16 * y + x); };
      for (int y = 5; y < 11; ++y) {
        const Rgb left = b.pixels[pixel(5, y)] / a.pixels[pixel(5, y)],
                  right = b.pixels[pixel(10, y)] / a.pixels[pixel(10, y)];
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(left[c], (Rgb{1, 0.25f, 0})[c], 0.002f) << y;
          EXPECT_NEAR(right[c], (Rgb{0, 0.25f, 1})[c], 0.002f) << y;
        }
      }
    }
}

/// What is black scatters nothing, and what is white nothing less than without a colour.
TEST(ColorGrid, BlackAndWhite) {
  MemoryScene black = box(Rgb(1)), white = box(Rgb(1));
  paint(black, [](const Vec3d&) { return Rgb(0); });
  paint(white, [](const Vec3d&) { return Rgb(1); });
  for (const EstimatorType type :
       {EstimatorType::path, EstimatorType::beam, EstimatorType::march}) {
    SCOPED_TRACE(type.name);
    const PassMeans dark = test::render_passes(black, type, 2),
                    bright = test::render_passes(white, type, 2),
                    plain = test::render_passes(box(Rgb(1)), type, 2);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(dark.total[c].mean(), 0);
      EXPECT_NEAR(bright.total[c].mean(), plain.total[c].mean(), 1e-4 * plain.total[c].mean());
    }
  }
}

} // namespace
} // namespace vdbeam
