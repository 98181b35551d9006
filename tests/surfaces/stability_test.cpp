#include "support/surface_test.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

using namespace test::surfaces;

/// Radiance over the square of the index is the same inside.
TEST(SurfaceStability, camera_inside_glass) {
  MemoryScene scene;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  add_surface(scene, SurfaceShape::sphere, scaled(1), glass());
  scene.look({0, 0, 0}, {0, 0, -1}, 60, 4, 4);
  expect_mean(render_passes(scene, EstimatorType::path, 64).total[0], 2.25, 1e-3);
}

TEST(SurfaceStability, camera_inside_a_solid_sees_nothing) {
  MemoryScene scene;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  scene.add_light(LightType::distant);
  add_surface(scene, SurfaceShape::sphere, scaled(1), white());
  scene.look({0, 0, 0}, {0, 0, -1}, 60, 4, 4);
  const PassMeans means = render_passes(scene, EstimatorType::path, 4);
  EXPECT_EQ(means.total[0].mean(), 0);
}

TEST(SurfaceStability, a_medium_half_inside_glass_is_a_furnace) {
  MemoryScene scene;
  scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 2;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.7), {1, 0, 0}), glass());
  scene.look({0, 0.5, 5}, {0.5, 0, 0}, 40, 8, 8);
  expect_mean(render_passes(scene, EstimatorType::path, 100).total[0], 1);
}

/// A lamp that lies in the plane of a wall lights as one just before it.
TEST(SurfaceStability, a_lamp_on_a_wall) {
  const auto floor_with_lamp_at = [](double height) {
    MemoryScene scene;
    add_surface(scene, SurfaceShape::disk, moved(scaled(0.4), {0, 0, height}), shining(1));
    add_surface(scene, SurfaceShape::quad, scaled(1), white());
    add_surface(scene, SurfaceShape::quad, moved(scaled(1), {0, 0, 1}, true), white());
    scene.look({0, 0, 0.5}, {0.2, 0, 1}, 60, 6, 6);
    return render_passes(scene, EstimatorType::path, 256).total[0];
  };
  test::expect_same_mean(floor_with_lamp_at(0), floor_with_lamp_at(1e-4), 1e-3);
}

/// In a solid there is no medium, also where a lamp stands in it.
TEST(SurfaceStability, a_lamp_inside_a_solid) {
  for (const EstimatorType& estimator : {EstimatorType::path, EstimatorType::beam}) {
    MemoryScene scene;
    VolumeSettings& fog = scene.add_box(Vec3d(-1), Vec3d(1));
    fog.extinction = 2;
    fog.albedo = Rgb(0);
    MaterialSettings solid = glass();
    solid.ior = 1;
    solid.solid = true;
    add_surface(scene, SurfaceShape::sphere, scaled(0.5), solid);
    add_surface(scene, SurfaceShape::sphere, scaled(0.2), shining(3));
    scene.look({0, 0, 1000}, {0, 0, 0}, 1e-3, 4, 4);
    // Half a unit of fog before the solid, none in it.
    expect_mean(render_passes(scene, estimator, 4).total[0], 3 * std::exp(-2 * 0.5), 1e-3);
  }
}

/// Rays that are totally reflected for ever bring nothing, and end.
TEST(SurfaceStability, light_that_cannot_leave_glass) {
  MemoryScene scene;
  scene.add_light(LightType::environment).radiance = Rgb(1);
  MaterialSettings diamond = glass();
  diamond.ior = 4;
  add_surface(scene, SurfaceShape::sphere, scaled(1), diamond);
  scene.look({0.9, 0, 0}, {0.9, 0, -1}, 10, 4, 4);
  for (const Rgb& pixel : render_passes(scene, EstimatorType::path, 8).pixels)
    EXPECT_EQ(max_component(pixel), 0);
}

/// Two walls in one place: the first counts, and no light comes between them.
TEST(SurfaceStability, coplanar_walls) {
  const auto lit = [](bool twice) {
    MemoryScene scene;
    scene.add_light(LightType::environment).radiance = Rgb(1);
    MaterialSettings grey;
    grey.albedo = Rgb(0.5f);
    add_surface(scene, SurfaceShape::quad, scaled(1), grey);
    if (twice)
      add_surface(scene, SurfaceShape::quad, scaled(1), of_type(MaterialType::mirror));
    scene.look({0, 0, 2}, {0, 0, 0}, 40, 4, 4);
    return render_passes(scene, EstimatorType::path, 64).total[0];
  };
  expect_mean(lit(true), 0.5);
  test::expect_same_mean(lit(true), lit(false));
}

/// Sizes and places that single precision cannot hold beside the rest of the scene are refused, and
/// those that it can are rendered.
TEST(SurfaceStability, surfaces_beyond_all_measure) {
  const auto complaint = [](const Transform& at) -> std::string {
    MemoryScene scene;
    scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 0.5;
    scene.add_light(LightType::distant);
    scene.scene.render.photons = 500;
    add_surface(scene, SurfaceShape::sphere, at, glass());
    scene.look({0, 0, 5}, {0, 0, 0}, 40, 4, 4);
    try {
      for (const Rgb& pixel : render_passes(scene, EstimatorType::beam, 1).pixels)
        EXPECT_TRUE(std::isfinite(mean_component(pixel)));
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  Transform thin = scaled(1);
  thin[10] = 1e-25;
  for (const double scale : {1e-11, 1e9})
    EXPECT_EQ(complaint(scaled(scale)), "") << scale;
  EXPECT_EQ(complaint(moved(scaled(1), {0, 1e15, 0})), "");
  for (const double scale : {1e-13, 1e-20, 1e-38, 1e-60})
    EXPECT_NE(complaint(scaled(scale)).find("mesh.0: is a million million times smaller"),
              std::string::npos)
        << scale;
  EXPECT_NE(complaint(thin).find("smaller, in some direction"), std::string::npos);
  for (const double scale : {1e10, 1e20, 1e38, 1e60})
    EXPECT_NE(complaint(scaled(scale)).find("millions of times larger"), std::string::npos)
        << scale;
  EXPECT_NE(complaint(moved(scaled(1), {1e30, 0, 0})).find("too far away"), std::string::npos);
}

class SurfaceScale : public ::testing::TestWithParam<EstimatorType> {};

/// The same scene at any scale and place gives the same picture, region by region.
TEST_P(SurfaceScale, does_not_matter) {
  const auto render_at = [](double scale, const Vec3d& at) {
    MemoryScene scene;
    scene.add_box(at - Vec3d(scale), at + Vec3d(scale)).extinction = 1 / scale;
    scene.scene.render.photons = 3000;
    LightSettings& sun = scene.add_light(LightType::distant);
    sun.direction = {0.3, -1, 0.2};
    sun.angular_radius = 2;
    SurfaceSettings& plane = add_surface(scene, SurfaceShape::quad, scaled(1), diffuse(0.5));
    plane.transform = {3 * scale,          0, 0,          at.x, 0,   0, scale,
                       at.y - 0.9 * scale, 0, -3 * scale, 0,    at.z};
    add_surface(scene, SurfaceShape::sphere, moved(scaled(0.4 * scale), at), glass());
    scene.look(at + Vec3d{0, 1, 5} * scale, at, 40, 16, 12);
    return render_passes(scene, GetParam(), GetParam() == EstimatorType::path ? 48 : 16);
  };
  const PassMeans reference = render_at(1, {0, 0, 0});
  const auto expect_same = [&](const char* where, const PassMeans& mine) {
    SCOPED_TRACE(where);
    test::expect_same_mean(mine.total[0], reference.total[0]);
    EXPECT_EQ(regions_apart(mine, reference, 0), 0);
  };
  expect_same("a thousandth", render_at(1e-3, {0, 0, 0}));
  expect_same("ten thousand", render_at(1e4, {0, 0, 0}));
  expect_same("far away", render_at(1, {1e6, 2e6, -1e6}));
  expect_same("far away and small", render_at(1e-3, {1e3, 2e3, -1e3}));
}

INSTANTIATE_TEST_SUITE_P(Surfaces, SurfaceScale,
                         ::testing::Values(EstimatorType::path, EstimatorType::beam,
                                           EstimatorType::march));

/// What holds for paths holds where photons bring the light.
class PhotonStability : public ::testing::TestWithParam<EstimatorType> {
protected:
  /// White fog under a white sky: every radiance is 1.
  static MemoryScene furnace() {
    MemoryScene scene;
    scene.add_box(Vec3d(-1), Vec3d(1)).extinction = 1;
    scene.scene.render.photons = 4000;
    scene.add_light(LightType::environment).radiance = Rgb(1);
    scene.look({0, 0.3, 4}, {0, 0, 0}, 30, 8, 8);
    return scene;
  }
};

TEST_P(PhotonStability, indices_of_a_half_and_four) {
  for (const double ior : {0.5, 4.0}) {
    MemoryScene scene = furnace();
    MaterialSettings material = glass();
    material.ior = ior;
    add_surface(scene, SurfaceShape::sphere, scaled(0.5), material);
    expect_mean(render_passes(scene, GetParam(), 12).total[0], 1, 0.02);
  }
}

/// Where the camera is, radiance is the square of the index times that outside.
TEST_P(PhotonStability, camera_inside_glass_in_fog) {
  MemoryScene scene = furnace();
  add_surface(scene, SurfaceShape::sphere, scaled(0.5), glass());
  scene.look({0, 0, 0}, {0, 0, -1}, 60, 8, 8);
  expect_mean(render_passes(scene, GetParam(), 12).total[0], 2.25, 0.05);
}

TEST_P(PhotonStability, a_medium_half_inside_glass) {
  MemoryScene scene = furnace();
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.7), {1, 0, 0}), glass());
  expect_mean(render_passes(scene, GetParam(), 12).total[0], 1, 0.02);
}

/// A room without an end to photons' paths: fog in it takes all light in, and without fog they end
/// all the same.
TEST_P(PhotonStability, a_closed_room_of_mirrors) {
  MemoryScene scene;
  VolumeSettings& fog = scene.add_box(Vec3d(-1), Vec3d(1));
  fog.extinction = 1;
  fog.albedo = Rgb(0.5f);
  scene.scene.render.photons = 4000;
  add_surface(scene, SurfaceShape::sphere, scaled(0.5), of_type(MaterialType::mirror));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.1), {0, 0.2, 0}), shining(1));
  scene.look({0.3, 0.1, 0}, {0, 0, -0.2}, 60, 8, 8);
  const PassMeans path = render_passes(scene, EstimatorType::path, 64);
  const PassMeans mine = render_passes(scene, GetParam(), 24);
  EXPECT_GT(path.total[0].mean(), 0.1);
  EXPECT_EQ(test::regions_apart(mine, path, 0.05), 0)
      << mine.total[0].mean() << " against " << path.total[0].mean();
  scene.scene.volumes[0].extinction = 1e-6;
  for (const Rgb& pixel : render_passes(scene, GetParam(), 2).pixels)
    EXPECT_TRUE(std::isfinite(mean_component(pixel)) && max_component(pixel * -1.0f) <= 0);
}

INSTANTIATE_TEST_SUITE_P(Surfaces, PhotonStability,
                         ::testing::Values(EstimatorType::beam, EstimatorType::march));

} // namespace
} // namespace vdbeam
