// Lights and cameras in awkward places.
#include "stability/stability_scene.h"

namespace vdbeam {
namespace {

using namespace test;

/// Beam and path agree on a scene, within their errors and `bias` of the mean. Paths that end close
/// to a light are rare and bright, so there are many.
void expect_same_picture(MemoryScene scene, const std::string& what, double bias) {
  scene.scene.render.photons = 20000;
  const PassMeans beam = render_sound(scene, EstimatorType::beam, 48, what);
  const PassMeans path = render_sound(scene, EstimatorType::path, 750, what);
  SCOPED_TRACE(what);
  expect_power(beam.total[0], 0.025 * path.total[0].mean());
  expect_power(path.total[0], 0.025 * path.total[0].mean());
  expect_same_mean(beam.total[0], path.total[0], bias * path.total[0].mean());
}

TEST(Lights, InsideTheMedium) {
  MemoryScene scene = box_scene(4, 0.9);
  scene.add_light(LightType::point).position = {0.31, 0.33, -0.1};
  scene.look({0, 0, 3}, {-0.2, -0.2, 0}, 4, 8, 8);
  expect_same_picture(scene, "inside", 0.02);
}

TEST(Lights, OnAVoxelFace) {
  MemoryScene scene = box_scene(4, 0.9);
  scene.add_light(LightType::point).position = {0.25, 0.25, 0.125};
  scene.look({0, 0, 3}, {-0.2, -0.2, 0}, 4, 8, 8);
  expect_same_picture(scene, "on a face", 0.02);
}

TEST(Lights, OnTheBorderOfTheMedium) {
  MemoryScene scene = box_scene(4, 0.9);
  scene.add_light(LightType::point).position = {0.5, 0.25, 0};
  scene.look({0, 0, 3}, {-0.2, -0.2, 0}, 4, 8, 8);
  expect_same_picture(scene, "on the border", 0.02);
}

/// Straight at the light: the rays beside it see 1 / distance^2, whose mean over the picture path
/// finds with the most noise.
TEST(Lights, InThePicture) {
  MemoryScene scene = box_scene(4, 0.9);
  scene.add_light(LightType::point).position = {0, 0, 0};
  const PassMeans path = render_sound(scene, EstimatorType::path, 750, "in the picture");
  expect_power(path.total[0], 0.03 * path.total[0].mean());
  scene.scene.render.photons = 20000;
  for (const EstimatorType type : {EstimatorType::beam, EstimatorType::march}) {
    const PassMeans means = render_sound(scene, type, 24, "in the picture");
    expect_power(means.total[0], 0.03 * path.total[0].mean());
    expect_same_mean(means.total[0], path.total[0], 0.02 * path.total[0].mean());
  }
}

TEST(Lights, AtTheCamera) {
  MemoryScene scene = box_scene(4, 0.9);
  scene.add_light(LightType::point).position = scene.scene.camera.position;
  expect_same_picture(scene, "at the camera", 0.02);
}

/// Nothing knows a horizon: light from below gives the mirrored picture of light from above.
TEST(Lights, SunBelowTheHorizon) {
  MemoryScene below = box_scene(4, 0.9), above = box_scene(4, 0.9);
  add_sun(below, {0.1, 1, -0.2});
  add_sun(above, {0.1, -1, -0.2});
  for (const EstimatorType type : {EstimatorType::beam, EstimatorType::path}) {
    const int passes = type == EstimatorType::path ? 32 : 12;
    const PassMeans a = render_sound(below, type, passes, "below"),
                    b = render_sound(above, type, passes, "above");
    expect_same_mean(a.total[0], b.total[0], 0.01 * b.total[0].mean());
    expect_power(a.total[0], 0.01 * a.total[0].mean());
    expect_power(b.total[0], 0.01 * a.total[0].mean());
  }
}

/// A field of view that shrinks as the camera recedes shows the same picture: from 1000 sizes on
/// the rays are as good as parallel.
TEST(Cameras, FarAway) {
  const auto from = [](double distance, EstimatorType type) {
    const Vec3<int> cells{2, 2, 2};
    MemoryScene scene;
    scene
        .add(closed_field(cells,
                          [](int i, int j, int k) {
                            return i + j > 12 ? 2.0 * lattice_noise(i, j, k) : 0.01;
                          }),
             box_map(cells, Vec3d(-0.5), Vec3d(0.5)))
        .extinction = 12;
    scene.scene.volumes[0].albedo = Rgb(0.9f);
    add_sun(scene, {0.6, -0.7, -0.4});
    const double fov = 2 * std::atan(0.5 / distance) * 180 / std::numbers::pi;
    scene.look({0, 0, distance}, {0, 0, 0}, fov, 16, 16);
    scene.scene.render.photons = 60000;
    return render_sound(scene, type, type == EstimatorType::path ? 24 : 12,
                        "distance " + std::to_string(distance));
  };
  for (const EstimatorType type : {EstimatorType::beam, EstimatorType::path}) {
    const PassMeans near = from(1e3, type);
    for (const double distance : {1e4, 1e5, 1e6, 1e8}) {
      SCOPED_TRACE(name_of(type) + " from " + std::to_string(distance));
      const PassMeans far = from(distance, type);
      expect_same_mean(far.total[0], near.total[0], 0.005 * near.total[0].mean());
      expect_power(far.total[0], 0.007 * near.total[0].mean());
    }
  }
}

TEST(Cameras, AgainstTheGrainOfTheLattice) {
  MemoryScene scene = box_scene(3, 0.9);
  add_sun(scene, {0, 0, -1});
  const double third = 1.0 / 3;
  for (const Vec3d& position :
       {Vec3d{0, 0, 0}, {0.125, 0.125, 0.125}, {0.5, 0, 0}, {0.5, 0.5, 0.5}, {third, 0, 0}})
    for (const Vec3d& direction : {Vec3d{0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {-1, -1, -1}}) {
      scene.look(position, position + direction, 1e-3, 4, 4);
      for (const EstimatorType type :
           {EstimatorType::beam, EstimatorType::march, EstimatorType::path})
        render_sound(scene, type, 1, "on the lattice");
    }
}

} // namespace
} // namespace vdbeam
