// What "auto" chooses, and that it renders what the estimator of that name does.
#include "choose/choose_estimator.h"

#include "support/make_field.h"
#include "support/statistics.h"
#include "support/surface_scene.h"
#include "support/test_frame.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <set>

namespace vdbeam {
namespace {

using namespace test;

/// A lumpy box of a given depth in mean free paths, seen whole.
MemoryScene lumps(double depth) {
  MemoryScene scene;
  const DensityField field = closed_field({16, 16, 16}, [](int i, int j, int k) {
    return (i / 2 + j / 2 + k / 2) % 2 == 0 ? 1.9 : 0.1;
  });
  VolumeSettings& volume = scene.add(field, box_map({16, 16, 16}, Vec3d(-0.5), Vec3d(0.5)));
  volume.extinction = depth;
  volume.albedo = Rgb(0.98f);
  scene.look({0.4, 0.3, 3}, {0, 0, 0}, 22, 64, 64);
  return scene;
}

/// So small that the photons of a pass are few; in large pictures `beam` is ahead.
MemoryScene thin_under_a_sky() {
  MemoryScene scene = lumps(1);
  scene.scene.image.width = scene.scene.image.height = 32;
  scene.add_light(LightType::environment);
  return scene;
}

MemoryScene deep_in_the_sun() {
  MemoryScene scene = lumps(40);
  scene.add_light(LightType::distant).direction = {-0.7, -0.5, -0.5};
  return scene;
}

class Choice {
public:
  explicit Choice(const MemoryScene& scene) : frame_(scene), path_plan_(path_plan(scene)) {
    const EstimatorInput input = frame_.input();
    choice = choose_estimator(input, input.with(path_plan_));
  }

private:
  static RenderPlan path_plan(MemoryScene scene) {
    scene.scene.render.estimator = EstimatorType::path;
    return TestFrame(scene).plan;
  }
  TestFrame frame_;
  RenderPlan path_plan_;

public:
  EstimatorChoice choice;
};

TEST(ChooseEstimator, PathInAThinMediumUnderAnEvenSky) {
  // A walk that leaves the medium finds the same light wherever it goes.
  const Choice thin(thin_under_a_sky());
  EXPECT_EQ(thin.choice.type.name, "path");
  EXPECT_EQ(thin.choice.photons, nullptr);
}

TEST(ChooseEstimator, GatherInADeepMediumInTheSun) {
  const Choice deep(deep_in_the_sun());
  EXPECT_EQ(deep.choice.type.name, "gather");
  ASSERT_NE(deep.choice.photons, nullptr);
}

/// Under a wide roof the sun reaches no cloud.
TEST(ChooseEstimator, PathWherePhotonsAreRare) {
  MemoryScene shaded = deep_in_the_sun();
  surfaces::add_surface(shaded, SurfaceShape::quad,
                        surfaces::moved(surfaces::scaled(400), {0, 0, 5}), surfaces::diffuse(0.5));
  const Choice choice(shaded);
  EXPECT_EQ(choice.choice.type.name, "path");
  EXPECT_NE(choice.choice.reason.find("light path"), std::string::npos) << choice.choice.reason;
}

/// The sun shines through a slit into a dark room with thin smoke: most light paths end on the
/// walls, but the few photons of the smoke are all that it needs.
TEST(ChooseEstimator, PhotonsInARoomWithLittleSmoke) {
  MemoryScene scene = lumps(0.06);
  scene.scene.image.width = scene.scene.image.height = 48;
  scene.add_light(LightType::distant).direction = {0.2, -0.3, -1};
  for (const double x : {-2.05, 2.05}) // two halves of a wall before the smoke
    surfaces::add_surface(scene, SurfaceShape::quad,
                          surfaces::moved(surfaces::scaled(2), {x, 0, 1}), surfaces::diffuse(0.5));
  surfaces::add_surface(scene, SurfaceShape::quad, surfaces::moved(surfaces::scaled(6), {0, 0, -1}),
                        surfaces::diffuse(0.5));
  const Choice choice(scene);
  EXPECT_NE(choice.choice.type.name, "path") << choice.choice.reason;
  ASSERT_NE(choice.choice.photons, nullptr);
  const PhotonPlan& plan = choice.choice.photons->choices().photons;
  EXPECT_LT(plan.stored_per_path, 0.05) << "photons are rare";
  EXPECT_LT(plan.stored_per_path * static_cast<double>(plan.paths), 500) << "and few";
}

TEST(ChooseEstimator, BeamWhereThereAreNoPhotons) {
  MemoryScene dark = deep_in_the_sun();
  dark.scene.volumes[0].albedo = Rgb(0);
  EXPECT_EQ(Choice(dark).choice.type.name, "beam");
}

/// Neighbouring frames of a shot are not to choose by chance: in a small picture the logarithm of
/// the forecast scattered by 0.27 where each of its few pixels was rendered twice only, now by
/// 0.16.
TEST(ChooseEstimator, ForecastsOfSmallPicturesAreSteady) {
  MemoryScene scene = lumps(3);
  scene.add_light(LightType::distant).direction = {-0.7, -0.5, -0.5};
  scene.add_light(LightType::environment).radiance = Rgb(0.1f);
  scene.scene.image.width = scene.scene.image.height = 40;
  Samples forecasts;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    scene.scene.render.seed = seed;
    const double lead = Choice(scene).choice.lead;
    ASSERT_GT(lead, 0);
    forecasts.add(std::log(lead));
  }
  EXPECT_LT(std::sqrt(forecasts.variance()), 0.22);
}

/// In thumbnails a handful of pixels stood for all others, and one at a dark rim could weigh
/// more than the rest: the logarithm of the deep scene's forecast scattered by 0.39, now by 0.16.
TEST(ChooseEstimator, ThumbnailsOfAnySeedChooseAlike) {
  for (MemoryScene scene : {thin_under_a_sky(), deep_in_the_sun()}) {
    scene.scene.image.width = 32;
    scene.scene.image.height = 18;
    Samples forecasts;
    std::set<std::string> chosen;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      scene.scene.render.seed = seed;
      const Choice made(scene);
      chosen.insert(std::string(made.choice.type.name));
      forecasts.add(std::log(made.choice.lead));
    }
    EXPECT_EQ(chosen.size(), 1u);
    EXPECT_LT(std::sqrt(forecasts.variance()), 0.3);
  }
}

TEST(ChooseEstimator, IsTheSameForAnyNumberOfThreads) {
  const MemoryScene scene = deep_in_the_sun();
  const std::string reason = Choice(scene).choice.reason;
  for (const int threads : {1, 3})
    tbb::task_arena(threads).execute([&] { EXPECT_EQ(Choice(scene).choice.reason, reason); });
}

/// The estimator that comes with the choice has its pilot behind it, and draws no other numbers.
TEST(ChooseEstimator, GivesItsOwnPicture) {
  const MemoryScene scene = deep_in_the_sun();
  Choice made(scene);
  const TestFrame frame(scene);
  PassImage chosen, named;
  RenderStatistics statistics;
  made.choice.photons->render_pass(0, chosen, statistics);
  make_pass_renderer(EstimatorType::automatic, frame.input())->render_pass(0, named, statistics);
  for (std::size_t i = 0; i < named.direct.size(); ++i)
    ASSERT_EQ(chosen.total(i), named.total(i)) << "pixel " << i;
}

} // namespace
} // namespace vdbeam
