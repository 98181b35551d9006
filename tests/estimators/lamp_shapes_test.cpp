// Lamps with a profile, a picture, a temperature or a power light fog alike however their light is
// found: by shadow rays and by photons, in every estimator.
#include "image/output_formats.h"
#include "support/ies_text.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using namespace test;

class LampShapes : public ::testing::Test {
protected:
  LampShapes() {
    write_bytes(folder_.file("lamp.ies"),
                ies_text(angles(0, 90, 18), angles(0, 360, 12), [](double v, double h) {
                  const double beam = std::exp(-(v - 25) * (v - 25) / 150);
                  return 5 + 100 * beam * (1.1 + std::cos(h * std::numbers::pi / 180));
                }));
    Image slide;
    slide.width = slide.height = 16;
    for (int c = 0; c < 3; ++c) {
      ImageChannel channel{std::string(1, "RGB"[c]), {}};
      for (int i = 0; i < 256; ++i)
        channel.data.push_back((i / 16 / 4 + i % 16 / 4) % 2 == 0 ? 0.1f + static_cast<float>(c)
                                                                  : 0);
      slide.channels.push_back(std::move(channel));
    }
    write_image(slide, folder_.file("slide.exr"));
  }

  /// A box of fog under a lamp that hangs above it.
  MemoryScene lit_by(LightType type) const {
    MemoryScene scene;
    VolumeSettings& box = scene.add_box(Vec3d(-0.5), Vec3d(0.5));
    box.extinction = 2;
    box.albedo = {0.9f, 0.8f, 0.7f};
    box.phase = henyey_greenstein(0.4);
    scene.scene.render.photons = 20000;
    scene.look({0, 0.2, 3}, {0, 0, 0}, 24, 16, 16);
    LightSettings& lamp = scene.add_light(type);
    lamp.position = {0.2, 1.1, 0.3};
    lamp.direction = {-0.15, -1, -0.2};
    lamp.cone_angle = 40;
    lamp.power = Rgb(10, 8, 6);
    lamp.kelvin = 3000;
    lamp.exposure = 0.5;
    return scene;
  }

  void expect_one_answer(MemoryScene scene, double noise = 0.01) const {
    const PassMeans path = render_passes(scene, EstimatorType::path, 400);
    expect_power(path.total[0], noise * path.total[0].mean());
    for (const DirectLight direct : {DirectLight::sampled, DirectLight::photons})
      for (const EstimatorType& estimator : {EstimatorType::beam, EstimatorType::march}) {
        SCOPED_TRACE(std::string(estimator.name) +
                     (direct == DirectLight::sampled ? "" : " photons"));
        scene.scene.render.direct = direct;
        const PassMeans means = render_passes(scene, estimator, 32);
        for (std::size_t c = 0; c < 3; ++c)
          expect_same_mean(means.total[c], path.total[c], 0.02 * path.total[c].mean());
        EXPECT_EQ(regions_apart(means, path, 0.1), 0);
      }
    scene.scene.render.direct = DirectLight::automatic;
    const PassMeans gathered = render_passes(scene, EstimatorType::gather, 32);
    for (std::size_t c = 0; c < 3; ++c)
      expect_same_mean(gathered.total[c], path.total[c], 0.02 * path.total[c].mean());
  }

  TempFolder folder_;
};

TEST_F(LampShapes, APointWithAProfile) {
  MemoryScene scene = lit_by(LightType::point);
  scene.scene.lights[0].ies = folder_.file("lamp.ies");
  scene.scene.lights[0].rotation = 40;
  expect_one_answer(scene);
}

TEST_F(LampShapes, ASpotWithAPicture) {
  MemoryScene scene = lit_by(LightType::spot);
  scene.scene.lights[0].image = folder_.file("slide.exr");
  expect_one_answer(scene);
}

TEST_F(LampShapes, ASpotWithBothInsideTheFog) {
  MemoryScene scene = lit_by(LightType::spot);
  scene.scene.lights[0].position = {0.1, 0.45, 0.2};
  scene.scene.lights[0].ies = folder_.file("lamp.ies");
  scene.scene.lights[0].image = folder_.file("slide.exr");
  constexpr double noise_near_a_lamp = 0.04;
  expect_one_answer(scene, noise_near_a_lamp);
}

/// Over a ground, towards which lamps are aimed apart from the medium.
TEST_F(LampShapes, OverAGround) {
  using namespace test::surfaces;
  MemoryScene scene = lit_by(LightType::spot);
  scene.scene.lights[0].image = folder_.file("slide.exr");
  scene.scene.lights[0].ies = folder_.file("lamp.ies");
  SurfaceSettings& ground = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.6));
  ground.transform = {3, 0, 0, 0, 0, 0, 1, -0.6, 0, -3, 0, 0};
  const PassMeans path = render_passes(scene, EstimatorType::path, 100);
  for (const EstimatorType& estimator : {EstimatorType::beam, EstimatorType::gather}) {
    SCOPED_TRACE(estimator.name);
    const PassMeans means = render_passes(scene, estimator, 24);
    for (std::size_t c = 0; c < 3; ++c)
      expect_same_mean(means.total[c], path.total[c], 0.03 * path.total[c].mean());
  }
}

} // namespace
} // namespace vdbeam
