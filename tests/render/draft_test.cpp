// A draft is the picture in fewer pixels: as bright as the picture, with its opacity and depth.
#include "render/draft.h"

#include "support/statistics.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace vdbeam {
namespace {

/// The sample of a cloud over a ground, beside balls of glass and metal.
Scene cloud_over_ground(const std::string& width, const std::string& height) {
  return load_scene(
      VDBEAM_SOURCE_DIR "/data/cloud_over_ground.toml", 1,
      {"image.width=" + width, "image.height=" + height, "render.estimator=\"auto\""});
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values)
    sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

TEST(Draft, IsAsBrightAsThePicture) {
  Scene scene = cloud_over_ground("96", "64");
  const PreparedScenePtr prepared = prepare_scene(scene);
  scene.render.passes = 4;
  const RenderResult full = render(scene, prepared, {}, {});
  const FrameSetup setup(scene, prepared, {0, 0, scene.image.width, scene.image.height});
  const StopToken stop;
  for (const int reduction : {2, 3, 5}) {
    Draft draft(scene, prepared, reduction, stop);
    ASSERT_TRUE(draft.add_pass());
    ASSERT_TRUE(draft.add_pass());
    EXPECT_EQ(draft.passes(), 2);
    const PassImage image = draft.enlarged(setup.input);
    ASSERT_EQ(image.width, scene.image.width);
    std::vector<float> red;
    for (std::size_t i = 0; i < image.direct.size(); ++i)
      red.push_back(image.total(i).x);
    const double wanted = mean(full.image.find("R")->data);
    EXPECT_NEAR(mean(red), wanted, 0.04 * wanted) << reduction;
    EXPECT_NEAR(mean(image.opacity), mean(full.image.find("A")->data), 0.01) << reduction;
    EXPECT_LT(*std::max_element(red.begin(), red.end()), 20) << reduction;
  }
}

TEST(Draft, StopsWhereItIsAsked) {
  const Scene scene = cloud_over_ground("96", "64");
  const PreparedScenePtr prepared = prepare_scene(scene);
  std::atomic<bool> request = true;
  const StopToken stop(&request);
  Draft draft(scene, prepared, 4, stop);
  EXPECT_FALSE(draft.add_pass());
  EXPECT_EQ(draft.passes(), 0);
}

/// A time limit that leaves room for a draft alone ends with a whole picture, which says what it
/// is.
TEST(Draft, StandsForAPassThatHasNoTime) {
  Scene scene = cloud_over_ground("1920", "1080"); // a pass takes a minute
  scene.render.passes.reset();
  scene.render.time = 6;
  const RenderResult result = render(scene);
  ASSERT_GT(result.draft, 1);
  EXPECT_EQ(result.stopped_by, "time");
  EXPECT_FALSE(result.quick_look);
  EXPECT_TRUE(result.passes.empty());
  EXPECT_EQ(std::count(result.image.find("R")->data.begin(), result.image.find("R")->data.end(), 0),
            0);
}

} // namespace
} // namespace vdbeam
