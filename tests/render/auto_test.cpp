// render.estimator = "auto": a render is that of the estimator that was chosen, and says which.
#include "report/report.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vdbeam {
namespace {

Scene cloud_by(EstimatorType estimator) {
  Scene scene = load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1,
                           {"image.width=64", "image.height=36", "render.passes=2"});
  scene.render.estimator = estimator;
  return scene;
}

/// As thin as haze, under a sky that is the same all around.
Scene haze(EstimatorType estimator) {
  Scene scene = cloud_by(estimator);
  scene.volumes[0].extinction = 0.2;
  LightSettings sky;
  sky.type = LightType::environment;
  scene.lights = {sky};
  return scene;
}

void expect_same_picture(const Image& a, const Image& b) {
  for (const char* channel : {"R", "G", "B"})
    EXPECT_EQ(a.find(channel)->data, b.find(channel)->data) << channel;
}

TEST(Auto, IsTheDefault) {
  EXPECT_EQ(RenderSettings().estimator.name, "auto");
}

TEST(Auto, RendersACloudByGather) {
  const Scene scene = cloud_by(EstimatorType::automatic);
  const RenderResult result = render(scene);
  EXPECT_EQ(result.plan.estimator, "gather");
  EXPECT_EQ(report_json(scene, result, {})["plan"]["estimator"], "gather");
  EXPECT_FALSE(result.plan.unbiased);
  expect_same_picture(result.image, render(cloud_by(EstimatorType::gather)).image);
}

/// Where final gathering is excluded, a note says why.
TEST(Gather, SaysWhereItGathersAlongRays) {
  Scene scene = cloud_by(EstimatorType::gather);
  EXPECT_EQ(render(scene).plan.schedule.at(0).estimator, "gather");
  scene.render.max_bounces = 50;
  const RenderResult result = render(scene);
  EXPECT_EQ(result.plan.schedule.at(0).estimator, "beam");
  const std::string note = "render.estimator = \"gather\" gathers along camera rays here: "
                           "render.max_bounces limits the scattering events";
  EXPECT_NE(std::find(result.notes.begin(), result.notes.end(), note), result.notes.end());
}

TEST(Auto, RendersHazeUnderAnEvenSkyByPath) {
  const RenderResult result = render(haze(EstimatorType::automatic));
  EXPECT_EQ(result.plan.estimator, "path");
  EXPECT_FALSE(result.plan.choice.empty());
  EXPECT_TRUE(result.plan.unbiased);
  EXPECT_EQ(result.statistics.bias_rays, 0u);
  expect_same_picture(result.image, render(haze(EstimatorType::path)).image);
}

TEST(Auto, PartsOfAFrameChooseAlike) {
  const test::TempFolder folder;
  const auto parts = test::render_parts(haze(EstimatorType::automatic), folder, {{0, 0}, {1, 1}});
  expect_same_picture(merge_partials(parts), render(haze(EstimatorType::automatic)).image);
}

} // namespace
} // namespace vdbeam
