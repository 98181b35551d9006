// A draft is the picture in fewer pixels: as bright as the picture, with its opacity and depth.
#include "render/draft.h"

#include "layers/scene_objects.h"
#include "support/statistics.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vdbeam {
namespace {

/// The sample of a cloud over a ground, beside balls of glass and metal.
Scene cloud_over_ground(const std::string& width, const std::string& height) {
  return load_scene(
      VDBEAM_SOURCE_DIR "/data/cloud_over_ground.toml", 1,
      {"image.width=" + width, "image.height=" + height, "render.estimator=\"auto\""});
}

PixelRegion whole(const Scene& scene) {
  return {0, 0, scene.image.raster_width(), scene.image.raster_height()};
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
  const FrameSetup setup(scene, prepared, whole(scene));
  const StopToken stop;
  for (const int reduction : {2, 3, 5}) {
    Draft draft(scene, prepared, whole(scene), reduction, stop);
    // A fifth of the size has 260 pixels: over 8 seeds its mean scatters by 0.8 % after 8 passes.
    constexpr int passes = 8;
    for (int pass = 0; pass < passes; ++pass)
      ASSERT_TRUE(draft.add_pass());
    EXPECT_EQ(draft.passes(), passes);
    draft.look_through();
    const PassImage image = draft.enlarged(setup.input, whole(scene));
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

/// One pass of a draft, enlarged over a part of the picture.
PassImage drafted(const Scene& scene, const PixelRegion& part, int reduction = 3) {
  const PreparedScenePtr prepared = prepare_scene(scene);
  const FrameSetup setup(scene, prepared, part);
  const StopToken stop;
  Draft draft(scene, prepared, part, reduction, stop);
  EXPECT_TRUE(draft.add_pass());
  draft.look_through();
  return draft.enlarged(setup.input, part);
}

std::vector<float> red_of(const PassImage& image) {
  std::vector<float> red;
  for (std::size_t i = 0; i < image.direct.size(); ++i)
    red.push_back(image.total(i).x);
  return red;
}

TEST(Draft, SharesItsLightAmongTheGroups) {
  Scene scene = cloud_over_ground("96", "64");
  scene.lights[0].group = "key";
  const PassImage image = drafted(scene, whole(scene));
  ASSERT_EQ(image.groups.size(), 2u); // "key" and the rest
  for (std::size_t i = 0; i < image.direct.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(image.groups[0][i][c] + image.groups[1][i][c], image.total(i)[c],
                  1e-4f * (1 + image.total(i)[c]));
  scene.render.passes = 2;
  const RenderResult full = render(scene);
  std::vector<float> key;
  for (const Rgb& light : image.groups[0])
    key.push_back(light.x);
  const double wanted = mean(full.image.find("light_key.R")->data);
  EXPECT_NEAR(mean(key), wanted, 0.1 * wanted);
}

/// A lamp that is mixed away must not leave a fringe at the edges of the surface that it lit.
TEST(Draft, LightsBehindASurfaceStayInTheirGroup) {
  const Scene scene = parse_scene(R"(
[image]
width = 64
height = 48
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
fov = 40
[[mesh]]
type = "quad"
rotate = [0, 0, 20]
material = { type = "diffuse", albedo = 0.8 }
[[light]]
type = "distant"
direction = [0, 0, -1]
irradiance = 20
group = "key"
[[light]]
type = "environment"
radiance = 0.5
[render]
estimator = "path"
)",
                                  "quad.toml");
  const PassImage image = drafted(scene, whole(scene), 4);
  ASSERT_EQ(image.groups.size(), 2U); // "key" and the rest
  int sky = 0, lit = 0;
  for (std::size_t i = 0; i < image.opacity.size(); ++i) {
    if (image.opacity[i] > 0.5f) {
      lit += image.groups[0][i].x > 2 ? 1 : 0;
      continue;
    }
    ++sky;
    EXPECT_LT(image.groups[0][i].x, 1e-4f) << i;
    EXPECT_NEAR(image.groups[1][i].x, 0.5f, 1e-4f) << i;
  }
  EXPECT_GT(sky, 1000);
  EXPECT_GT(lit, 500);
}

TEST(Draft, KnowsWhatEachObjectCovers) {
  Scene scene = cloud_over_ground("96", "64");
  scene.image.cryptomatte = true;
  scene.layers = {{"alpha"}, {"position"}};
  ASSERT_TRUE(Draft::can_show(scene));
  const PassImage image = drafted(scene, whole(scene));
  ASSERT_EQ(image.coverage.size(), scene_objects(scene).names.size());
  ASSERT_EQ(image.planes.size(), 3u);
  for (std::size_t i = 0; i < image.opacity.size(); ++i) {
    float covered = 0;
    for (const std::vector<float>& object : image.coverage)
      covered += object[i];
    ASSERT_NEAR(covered, image.opacity[i], 1e-3f);
  }
  scene.layers = {{"volumes"}};
  EXPECT_FALSE(Draft::can_show(scene)); // it has no light of single volumes
  scene.layers.clear();
  scene.image.deep = true;
  EXPECT_FALSE(Draft::can_show(scene));
}

/// A part of the picture, beyond its border too, is as it is in the whole picture.
TEST(Draft, ShowsRegionsAndOverscan) {
  Scene scene = cloud_over_ground("96", "64");
  scene.image.overscan = 12;
  const PassImage all = drafted(scene, whole(scene));
  const PixelRegion corner{0, 40, 60, 88};
  const PassImage part = drafted(scene, corner);
  ASSERT_EQ(part.width, 60);
  ASSERT_EQ(part.height, 48);
  std::vector<float> of_all, opacity_of_all;
  const std::vector<float> red = red_of(all);
  for (int y = corner.y0; y < corner.y1; ++y)
    for (int x = corner.x0; x < corner.x1; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(all.width) +
                            static_cast<std::size_t>(x);
      of_all.push_back(red[i]);
      opacity_of_all.push_back(all.opacity[i]);
    }
  EXPECT_NEAR(mean(red_of(part)), mean(of_all), 0.1 * mean(of_all));
  EXPECT_NEAR(mean(part.opacity), mean(opacity_of_all), 0.01);
  Scene larger = scene; // the same view in pixels of its own
  larger.image.width += 24;
  larger.image.height += 24;
  larger.image.overscan = 0;
  larger.camera.fov = 2 *
                      std::atan(std::tan(larger.camera.fov * std::numbers::pi / 360) *
                                larger.image.height / scene.image.height) *
                      180 / std::numbers::pi;
  const PassImage alike = drafted(larger, whole(larger));
  EXPECT_NEAR(mean(alike.opacity), mean(all.opacity), 0.02);
  EXPECT_NEAR(mean(red_of(alike)), mean(red), 0.1 * mean(red));
}

/// Photons would take minutes there, as `auto` knows before it runs the pilot of beam.
TEST(Draft, TakesPathWherePhotonsAreRare) {
  Scene scene = cloud_over_ground("48", "32");
  scene.volumes[0].extinction = 1e7;
  const PassImage image = drafted(scene, whole(scene));
  EXPECT_GT(mean(red_of(image)), 0);
}

TEST(Draft, StopsWhereItIsAsked) {
  const Scene scene = cloud_over_ground("96", "64");
  const PreparedScenePtr prepared = prepare_scene(scene);
  std::atomic<bool> request = true;
  const StopToken stop(&request);
  Draft draft(scene, prepared, whole(scene), 4, stop);
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
