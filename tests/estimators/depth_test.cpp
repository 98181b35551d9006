#include "film/film.h"
#include "support/render_passes.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

using test::MemoryScene;

constexpr double front = 10, back = 12; // distances from the camera

/// A box from z = -2 to z = 0, seen along -z from z = 10 through a very long lens.
MemoryScene box_scene(double extinction) {
  MemoryScene scene;
  VolumeSettings& volume = scene.add_box({-1, -1, -2}, {1, 1, 0});
  volume.extinction = extinction;
  volume.albedo = Rgb(0.5f);
  scene.add_light(LightType::environment);
  scene.scene.render.photons = 1000;
  return scene;
}

std::vector<float> depths(MemoryScene scene, EstimatorType type, int passes = 1) {
  scene.scene.render.estimator = type;
  const test::TestFrame frame(scene);
  const std::unique_ptr<PassRenderer> estimator = frame.estimator();
  Film film(frame.camera.width(), frame.camera.height());
  PassImage image;
  RenderStatistics statistics;
  for (int pass = 0; pass < passes; ++pass) {
    estimator->render_pass(pass, image, statistics);
    film.add(image);
  }
  return film.develop().find("depth.Z")->data;
}

/// Mean distance at which light is extinguished between `front` and `back`.
double mean_depth(double sigma) {
  const double tau = sigma * (back - front);
  return front + 1 / sigma - (back - front) / std::expm1(tau);
}

constexpr EstimatorType estimators[] = {EstimatorType::beam, EstimatorType::march,
                                        EstimatorType::path};

TEST(Depth, OfABoxIsItsTrueDistanceAtAnyOpacity) {
  for (const double sigma : {1e-4, 0.1, 1.0, 3.0, 50.0}) {
    MemoryScene scene = box_scene(sigma);
    scene.look({0, 0, front}, {0, 0, 0}, 0.1, 4, 4);
    for (const EstimatorType type : estimators)
      for (const float depth : depths(scene, type))
        EXPECT_NEAR(depth, mean_depth(sigma), 2e-3) << "extinction " << sigma;
  }
}

// A channel's opacity weighs its own mean distance.
TEST(Depth, IsTheMeanOverColours) {
  MemoryScene scene = box_scene(4);
  scene.scene.volumes[0].extinction_scale = {1, 0.5f, 0.05f};
  scene.look({0, 0, front}, {0, 0, 0}, 0.1, 4, 4);
  double sum = 0, weight = 0;
  for (const double sigma : {4.0, 2.0, 0.2}) {
    const double opacity = -std::expm1(-sigma * (back - front));
    sum += opacity * mean_depth(sigma);
    weight += opacity;
  }
  for (const EstimatorType type : estimators)
    for (const float depth : depths(scene, type))
      EXPECT_NEAR(depth, sum / weight, 2e-3);
}

// Pixels that the box covers in part are as far away as the box, and those beside it are far
// behind everything.
TEST(Depth, AtTheEdgeIsThatOfTheBoxAndBesideItFar) {
  MemoryScene scene = box_scene(1);
  scene.look({0, 0, front}, {0, 0, 0}, 20, 5, 5); // its sides lie at +- 0.57 of the picture
  for (const EstimatorType type : estimators) {
    const std::vector<float> depth = depths(scene, type, 8);
    int inside = 0, far = 0;
    for (const float z : depth) {
      far += z == 1e10f;
      inside += z > 9.99f && z < 12.3f;
    }
    EXPECT_EQ(inside + far, 25);
    EXPECT_GE(inside, 9);
    EXPECT_GE(far, 4);
  }
}

} // namespace
} // namespace vdbeam
