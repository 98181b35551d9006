// Photons among surfaces: what path tracing finds without bias, beam and march find too.
#include "support/surface_test.h"

#include <gtest/gtest.h>

#include <map>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// A box of fog in view, with a little albedo to lose.
MemoryScene fog(double extinction) {
  MemoryScene scene;
  VolumeSettings& box = scene.add_box(Vec3d(-1), Vec3d(1));
  box.extinction = extinction;
  box.albedo = Rgb(0.9f);
  scene.scene.render.photons = 20000;
  scene.look({0, 0.3, 4}, {0, 0, 0}, 34, 16, 16);
  return scene;
}

class AmongSurfaces : public ::testing::TestWithParam<EstimatorType> {
protected:
  /// Region by region the same as path tracing, but for a relative bias. Path tracing of the scene
  /// of a name is done once for all estimators.
  void expect_as_path(const std::string& name, const MemoryScene& scene, int passes,
                      int path_passes, double bias) const {
    static std::map<std::string, PassMeans> by_path;
    const auto [found, is_new] = by_path.try_emplace(name);
    if (is_new)
      found->second = render_passes(scene, EstimatorType::path, path_passes);
    const PassMeans& path = found->second;
    const PassMeans mine = render_passes(scene, GetParam(), passes);
    EXPECT_GT(path.total[0].mean(), 1e-3);
    EXPECT_EQ(regions_apart(mine, path, bias), 0)
        << mine.total[0].mean() << " against " << path.total[0].mean();
  }
};

/// The photons are many enough for kernels whose blur at the faces of the box stays below the
/// bound.
TEST_P(AmongSurfaces, white_furnaces) {
  for (const MaterialSettings& material :
       {of_type(MaterialType::mirror), glass(), glass(true), diffuse(1)}) {
    MemoryScene scene = fog(2);
    scene.scene.volumes[0].albedo = Rgb(1);
    scene.scene.render.photons = 200000;
    scene.add_light(LightType::environment).radiance = Rgb(1);
    add_surface(scene, SurfaceShape::sphere, scaled(0.5), material);
    const PassMeans mine = render_passes(scene, GetParam(), 10);
    expect_mean(mine.total[0], 1, 0.01);
    expect_power(mine.total[0], 0.005);
  }
}

/// A lamp, walls that reflect, a thin sheet and a corner.
TEST_P(AmongSurfaces, walls_and_a_lamp) {
  MemoryScene scene = fog(1);
  add_surface(scene, SurfaceShape::quad, moved(scaled(1), {0, 0, -0.9}), diffuse(0.7f));
  SurfaceSettings& floor = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.5f));
  floor.transform = {1, 0, 0, 0, 0, 0, 1, -0.8, 0, -1, 0, 0};
  SurfaceSettings& sheet = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.3f));
  sheet.transform = {0, 0, 0.5, 0.1, 0, 0.5, 0, -0.3, -0.5, 0, 0, 0};
  SurfaceSettings& lamp = add_surface(scene, SurfaceShape::disk, scaled(1), shining(5));
  lamp.transform = {0.3, 0, 0, -0.4, 0, 0, -1, 0.9, 0, 0.3, 0, 0};
  expect_as_path("walls", scene, 24, 32, 0.02);
}

/// Light that glass focuses into fog, from a lamp that is wide enough for path tracing to meet.
TEST_P(AmongSurfaces, a_ball_of_glass_before_a_lamp) {
  for (const bool solid : {false, true}) {
    MemoryScene scene = fog(0.7);
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.4), {-0.2, 0, 0}), glass(solid));
    SurfaceSettings& lamp = add_surface(scene, SurfaceShape::disk, scaled(1), shining(20));
    lamp.transform = {0, 0, 1, -1.6, 0, 0.25, 0, 0, -0.25, 0, 0, 0};
    expect_as_path(solid ? "solid ball" : "ball", scene, 48, 288, 0.03);
  }
}

/// A mirror shows the fog, and lights it.
TEST_P(AmongSurfaces, a_mirror_in_the_sun) {
  MemoryScene scene = fog(1.5);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {1, -1, -0.5};
  sun.angular_radius = 4;
  sun.irradiance = Rgb(3);
  SurfaceSettings& mirror =
      add_surface(scene, SurfaceShape::quad, scaled(1), of_type(MaterialType::mirror));
  mirror.transform = {1.2, 0, 0, 0, 0, 0.3, 1, -0.5, 0, -1.2, 0.3, 0};
  expect_as_path("mirror", scene, 32, 64, 0.02);
}

/// A cloud over a ground, with a forward peak.
TEST_P(AmongSurfaces, a_ground_in_the_sun) {
  MemoryScene scene = fog(4);
  scene.scene.volumes[0].phase = test::henyey_greenstein(0.8);
  scene.scene.volumes[0].albedo = Rgb(0.99f);
  scene.add_light(LightType::environment).radiance = Rgb(0.2f);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0.5, -1, -0.3};
  sun.irradiance = Rgb(3);
  SurfaceSettings& ground = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.6f));
  ground.transform = {3, 0, 0, 0, 0, 0, 1, -1.3, 0, -3, 0, 0};
  expect_as_path("ground", scene, 32, 48, 0.03);
}

/// Fog on either side of a thin black sheet: the sun lights one side, the other stays black, and
/// photons bring all light, so that only kernels could leak.
MemoryScene sheet_in_the_sun() {
  MemoryScene scene = fog(1);
  LightSettings& sun = scene.add_light(LightType::distant);
  sun.direction = {0, 0, -1};
  sun.irradiance = Rgb(3);
  add_surface(scene, SurfaceShape::quad, scaled(3), diffuse(0));
  scene.scene.render.direct = DirectLight::photons;
  scene.scene.render.kernel = KernelRadius::fixed;
  scene.scene.render.radius = 0.16;
  return scene;
}

TEST_P(AmongSurfaces, no_light_leaks_through_a_sheet) {
  MemoryScene scene = sheet_in_the_sun();
  scene.look({4, 0, -0.5}, {0, 0, -0.49}, 14, 32, 32);
  for (const Rgb& pixel : render_passes(scene, GetParam(), 4).pixels)
    EXPECT_EQ(max_component(pixel), 0);
}

/// Single scattering in a layer before the sheet that is thinner than a kernel, seen along it: in
/// closed form. Kernels that were cut off at the sheet would lose part of it.
TEST_P(AmongSurfaces, there_is_no_dark_seam_before_a_sheet) {
  MemoryScene scene = sheet_in_the_sun();
  scene.scene.render.max_bounces = 1;
  scene.look({40, 0, 0.045}, {0, 0, 0.045}, 0.1146, 16, 16); // from 0.005 to 0.085
  const double expected = 0.9 * 3 / (4 * M_PI) * std::exp(-1 + 0.045) * (1 - std::exp(-2.0));
  expect_mean(render_passes(scene, GetParam(), 16).total[0], expected, 0.05 * expected);
  scene.look({0, 0, 40}, {0, 0, 0}, 1, 16, 16);
  const double straight = 0.9 * 3 / (4 * M_PI) * (1 - std::exp(-2.0)) / 2;
  expect_mean(render_passes(scene, GetParam(), 16).total[0], straight, 0.02 * straight);
}

INSTANTIATE_TEST_SUITE_P(Photons, AmongSurfaces,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march),
                         [](const auto& estimator) { return std::string(estimator.param.name); });

} // namespace
} // namespace vdbeam
