// What stands beside a cloud, unseen, or shines next to nothing, changes neither how the cloud is
// rendered nor its error.
#include "support/lumpy_cloud.h"
#include "support/render_passes.h"
#include "support/surface_scene.h"

#include "choose/feature.h"
#include "photons/photon_plan.h"

#include <gtest/gtest.h>

#include <functional>

namespace vdbeam {
namespace {

using namespace test;
using surfaces::add_surface;
using surfaces::moved;
using surfaces::scaled;

MemoryScene cloud() {
  MemoryScene scene = lumpy_cloud(80, 48);
  scene.scene.volumes[0].albedo = Rgb(0.99f);
  scene.scene.volumes[0].phase = henyey_greenstein(0.85);
  scene.add_light(LightType::environment).radiance = Rgb(0.1f);
  scene.scene.render.estimator = EstimatorType::automatic;
  return scene;
}

struct Addition {
  std::string_view name;
  std::function<void(MemoryScene&)> add;
};

const std::vector<Addition>& additions() {
  static const std::vector<Addition> list{
      {"a ball behind the camera",
       [](MemoryScene& s) {
         add_surface(s, SurfaceShape::sphere, moved(scaled(0.01), {0.6, 0.7, 3.5}),
                     surfaces::diffuse(0.5));
       }},
      {"a ball of glass behind the camera",
       [](MemoryScene& s) {
         add_surface(s, SurfaceShape::sphere, moved(scaled(0.01), {0.6, 0.7, 3.5}),
                     surfaces::glass());
       }},
      {"a coin far below",
       [](MemoryScene& s) {
         add_surface(s, SurfaceShape::disk, moved(scaled(0.01), {0, -40, 0}),
                     surfaces::diffuse(0.5));
       }},
      {"a lamp far off",
       [](MemoryScene& s) {
         LightSettings& lamp = s.add_light(LightType::point);
         lamp.position = {30, 40, -20};
         lamp.intensity = Rgb(1e-4f);
       }},
      {"a lamp in the cloud",
       [](MemoryScene& s) {
         LightSettings& lamp = s.add_light(LightType::point);
         lamp.position = {0.1, 0.1, 0.1};
         lamp.intensity = Rgb(1e-4f);
       }},
      {"a lamp in a closed box",
       [](MemoryScene& s) {
         s.add_light(LightType::point).position = {0, -3, 0};
         add_surface(s, SurfaceShape::box, moved(scaled(0.2), {0, -3, 0}), surfaces::diffuse(0.5));
       }},
      {"the sun in a group of its own", [](MemoryScene& s) { s.scene.lights[0].group = "sun"; }},
      {"a limit that no path reaches", [](MemoryScene& s) { s.scene.render.max_bounces = 100000; }},
      {"a wide fog that is hardly there",
       [](MemoryScene& s) { s.add_box(Vec3d(-30), Vec3d(30)).extinction = 1e-5; }},
      {"a faint glow far off", [](MemoryScene& s) {
         s.add_box({-0.1, -40.1, -0.1}, {0.1, -40, 0.1}).albedo = Rgb();
         s.glow(uniform_field({1, 1, 1}, 1),
                box_map({1, 1, 1}, {-0.1, -40.1, -0.1}, {0.1, -40, 0.1}))
             .scale = 1e-4;
       }}};
  return list;
}

/// Features and errors of a few passes.
struct Outcome {
  std::vector<FeatureChoice> features;
  std::vector<Rgb> pixels;
};

constexpr int tested_passes = 4, truth_passes = 48;

/// The first passes, and passes behind them as their truth, which has none of their noise.
struct Outcomes {
  Outcome tested;
  std::vector<Rgb> truth;
};

Outcomes outcomes_of(const MemoryScene& scene, bool with_truth = true) {
  const TestFrame frame(scene);
  EstimatorInput input = frame.input();
  input.reaches_bounce_limit = reach_bounce_limit(input);
  FramePasses renderer(EstimatorType::automatic, input);
  Outcomes outcomes;
  outcomes.tested = {
      describe_features(input, estimator_kind(EstimatorType::automatic), renderer.choices()),
      means_of(renderer, 0, tested_passes).pixels};
  if (with_truth)
    outcomes.truth = means_of(renderer, tested_passes, truth_passes).pixels;
  return outcomes;
}

/// Those of the cloud alone, rendered once.
const Outcomes& of_the_cloud() {
  static const Outcomes outcomes = outcomes_of(cloud());
  return outcomes;
}

double error_of(const std::vector<Rgb>& pixels, const std::vector<Rgb>& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double value = static_cast<double>(mean_component(pixels[i])),
                 wanted = static_cast<double>(mean_component(truth[i]));
    sum += (value - wanted) * (value - wanted) / ((wanted + 0.01) * (wanted + 0.01));
  }
  return sum / static_cast<double>(pixels.size());
}

double error_of(const Outcomes& outcomes) {
  return error_of(outcomes.tested.pixels, outcomes.truth);
}

bool is_on(const Outcome& outcome, std::string_view name) {
  for (const FeatureChoice& feature : outcome.features)
    if (feature.name == name)
      return feature.on;
  return false;
}

/// The error of four passes is the mean of 2,304 pixels and scatters by a tenth (measured with
/// other seeds); before the method went on among surfaces it was 5 to 20 times as great.
TEST(NoCliffs, WhatIsUnseenChangesNothing) {
  const double plain = error_of(of_the_cloud());
  for (const Addition& addition : additions()) {
    MemoryScene scene = cloud();
    addition.add(scene);
    const Outcome outcome = outcomes_of(scene, false).tested;
    for (const std::string_view name : {"view importance", "path guide", "kernel pilot",
                                        "forward peak", "final gathering", "refined edges"})
      EXPECT_TRUE(is_on(outcome, name)) << addition.name << ": " << name;
    EXPECT_LT(error_of(outcome.pixels, of_the_cloud().truth), 1.38 * plain) << addition.name;
  }
}

/// The cloud in a wide layer of fog that lights it and dims it by some percent: photons reach the
/// cloud, and those of the fog are no fireflies in it. When they were aimed at all of the medium
/// and shared kernels, the error was 30 times that of the cloud alone.
TEST(NoCliffs, FogAroundACloudAddsLittleNoise) {
  MemoryScene scene = cloud();
  VolumeSettings& fog = scene.add_box({-30, -1, -30}, {30, 3, 30});
  fog.extinction = 0.02;
  fog.albedo = Rgb(0.99f);
  fog.phase = henyey_greenstein(0.7);
  EXPECT_LT(error_of(outcomes_of(scene)), 3 * error_of(of_the_cloud()));
}

/// A ground, a ball and a mirror in sunlight through the cloud, and a lamp above.
MemoryScene shot() {
  MemoryScene scene = cloud();
  scene.scene.volumes[0].extinction = 20;
  scene.scene.lights[0].direction = {0.3, -1, -0.4};
  MaterialSettings mirror = surfaces::of_type(MaterialType::mirror);
  surfaces::Transform flat{3, 0, 0, 0, 0, 0, 3, -0.7, 0, -3, 0, 0};
  add_surface(scene, SurfaceShape::quad, flat, surfaces::diffuse(0.4));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {0.45, -0.5, 0.4}),
              surfaces::diffuse(0.6));
  add_surface(scene, SurfaceShape::sphere, moved(scaled(0.15), {-0.45, -0.5, 0.4}), mirror);
  add_surface(scene, SurfaceShape::disk, moved(scaled(0.3), {-1.2, 1.5, 0.5}, true),
              surfaces::shining(4));
  scene.look({0.5, 0.4, 3}, {0, -0.1, 0}, 30, 16, 16);
  return scene;
}

/// Without bias of kernels to speak of, walks that meet surfaces, the light that only the peak
/// scatters, and photons that are aimed at the medium give what the path tracer gives.
TEST(NoCliffs, GatheringAmongSurfacesIsRight) {
  const MemoryScene scene = shot();
  const PassMeans gathered = render_passes(scene, EstimatorType::gather, 48);
  const PassMeans truth = render_passes(scene, EstimatorType::path, 192);
  EXPECT_EQ(regions_apart(gathered, truth, 0.02), 0);
  expect_same_mean(gathered.total[0], truth.total[0], 0.01);
}

/// The photons that reach the medium, and what they bring, do not depend on how wide the ground is.
TEST(NoCliffs, AWideGroundCostsNoPhotons) {
  const auto stored = [](double ground) {
    MemoryScene scene = cloud();
    const surfaces::Transform flat{ground, 0, 0, 0, 0, 0, ground, -0.7, 0, -ground, 0, 0};
    add_surface(scene, SurfaceShape::quad, flat, surfaces::diffuse(0.3));
    const TestFrame frame(scene);
    PhotonPassSettings settings =
        pass_settings(frame.input(), default_photon_plan(frame.input()), 1);
    settings.paths = 4000;
    return trace_photons(frame.world, settings).mean_collisions;
  };
  const double narrow = stored(1);
  for (const double ground : {10.0, 100.0, 1000.0})
    EXPECT_GT(stored(ground), 0.5 * narrow) << ground;
}

} // namespace
} // namespace vdbeam
