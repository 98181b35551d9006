#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

namespace vdbeam {
namespace {

constexpr int width = 30, height = 20, beyond = 5;

Scene cloud_with_overscan(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=30", "image.height=20", "image.overscan=5",
                                     "render.photons=1500", "render.passes=4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1, overrides);
}

float value(const Image& image, const char* name, int x, int y) {
  return image.find(name)
      ->data[static_cast<std::size_t>((y - image.y) * image.width + x - image.x)];
}

TEST(Overscan, ReachesBeyondThePicture) {
  const test::TempFolder folder;
  const Image image = render(cloud_with_overscan()).image;
  EXPECT_EQ(image.x, -beyond);
  EXPECT_EQ(image.y, -beyond);
  EXPECT_EQ(image.width, width + 2 * beyond);
  EXPECT_EQ(image.full_width, width);
  EXPECT_EQ(image.full_height, height);
  // In the file the picture is the display window: programs that do not want more show that.
  write_exr(image, folder.file("a.exr"));
  const Image shown = read_image(folder.file("a.exr"));
  ASSERT_EQ(shown.width, width);
  ASSERT_EQ(shown.height, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      EXPECT_EQ(value(shown, "depth.Z", x, y), value(image, "depth.Z", x, y));
}

TEST(Overscan, ShowsWhatAWiderPictureShows) {
  const Image image =
      render(cloud_with_overscan({"render.passes=16", "render.estimator=path"})).image;
  Scene wide =
      cloud_with_overscan({"render.passes=16", "render.estimator=path", "image.overscan=0"});
  wide.image.width = width + 2 * beyond;
  wide.image.height = height + 2 * beyond;
  const double tangent = std::tan(wide.camera.fov * M_PI / 360);
  wide.camera.fov = 360 / M_PI * std::atan(tangent * (height + 2.0 * beyond) / height);
  const Image other = render(wide).image;
  // The same pixels with the same random numbers; only the rounding of the rays differs.
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < other.find("A")->data.size(); ++i) {
    difference +=
        std::abs(static_cast<double>(image.find("A")->data[i] - other.find("A")->data[i]));
    sum += static_cast<double>(other.find("A")->data[i]);
  }
  EXPECT_LT(difference, 1e-3 * sum);
}

TEST(Overscan, RegionsCountFromThePicture) {
  const Scene scene = cloud_with_overscan();
  const Image whole = render(scene).image;
  FrameSettings frame;
  frame.region = PixelRegion{-3, -5, 9, 4};
  const Image part = render(scene, frame).image;
  EXPECT_EQ(part.x, -3);
  EXPECT_EQ(part.y, -5);
  for (int y = -5; y < 4; ++y)
    for (int x = -3; x < 9; ++x)
      EXPECT_EQ(value(part, "R", x, y), value(whole, "R", x, y)) << x << " " << y;
}

TEST(Overscan, PartsMerge) {
  const test::TempFolder folder;
  const Scene scene = cloud_with_overscan();
  const Image whole = render(scene).image;
  const Image merged = merge_partials(test::render_parts(scene, folder, {{0, 1}, {2, 3}}));
  EXPECT_EQ(merged.x, -beyond);
  EXPECT_EQ(merged.full_width, width);
  EXPECT_EQ(merged.find("R")->data, whole.find("R")->data);
}

} // namespace
} // namespace vdbeam
