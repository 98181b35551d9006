#include "support/image_checks.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vdbeam {
namespace {

using test::plane;

/// The sample cloud in a sun and a sky.
Scene sunlit_cloud(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=32", "image.height=18", "render.photons=3000",
                                     "render.passes=8"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/sunlit_cloud.toml", 1, overrides);
}

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float value : values)
    sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

std::string error_of(const std::vector<std::string>& overrides) {
  try {
    sunlit_cloud(overrides);
  } catch (const InputError& error) {
    const std::string text = error.what();
    return text.substr(text.find(": ") + 2);
  }
  return {};
}

class GroupsOfLights : public testing::TestWithParam<const char*> {};

/// Groups add up to the picture, pixel by pixel.
TEST_P(GroupsOfLights, AddUpToTheBeauty) {
  const std::string estimator = std::string("render.estimator=") + GetParam();
  const Scene scene = sunlit_cloud({estimator, "light.0.group=sun"});
  const Image image = render(scene).image;
  for (const char* channel : {"R", "G", "B"}) {
    const auto &all = plane(image, channel),
               &sun = plane(image, std::string("light_sun.") + channel),
               &rest = plane(image, std::string("light_rest.") + channel);
    for (std::size_t i = 0; i < all.size(); ++i)
      ASSERT_NEAR(sun[i] + rest[i], all[i], 1e-6 * (std::abs(all[i]) + 1e-3)) << i;
    EXPECT_GT(mean(sun), 0);
    EXPECT_GT(mean(rest), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Estimators, GroupsOfLights, testing::Values("beam", "path", "march"),
                         [](const auto& test) { return std::string(test.param); });

TEST(Layers, MergedPartsHaveTheGroups) {
  const test::TempFolder folder;
  const Scene scene =
      sunlit_cloud({"light.0.group=sun", "layer.0.name=lights", "layer.1.name=depth"});
  const Image whole = render(scene).image;
  const Image merged = merge_partials(test::render_parts(scene, folder, {{0, 2}, {3, 7}}));
  ASSERT_EQ(merged.channels.size(), whole.channels.size());
  for (std::size_t c = 0; c < whole.channels.size(); ++c) {
    EXPECT_EQ(merged.channels[c].name, whole.channels[c].name);
    EXPECT_EQ(merged.channels[c].data, whole.channels[c].data) << whole.channels[c].name;
  }
}

TEST(Layers, AreChosenByName) {
  const Image image = render(sunlit_cloud({"layer.0.name=depth", "layer.1.name=background",
                                           "layer.1.precision=float", "layer.2.name=transmittance",
                                           "layer.3.name=variance"}))
                          .image;
  std::vector<std::string> names;
  for (const ImageChannel& channel : image.channels)
    names.push_back(channel.name);
  EXPECT_EQ(names, (std::vector<std::string>{"R", "G", "B", "depth.Z", "background.R",
                                             "background.G", "background.B", "transmittance.Y",
                                             "variance.R", "variance.G", "variance.B"}));
  EXPECT_FALSE(image.find("background.R")->half);
  EXPECT_TRUE(image.find("R")->half);
  // The usual image gives the expected values.
  const Image usual = render(sunlit_cloud()).image;
  for (std::size_t i = 0; i < plane(usual, "R").size(); ++i) {
    EXPECT_NEAR(plane(image, "background.G")[i], plane(usual, "G")[i] - plane(usual, "volume.G")[i],
                1e-5);
    EXPECT_NEAR(plane(image, "transmittance.Y")[i], 1 - plane(usual, "A")[i], 1e-6);
  }
  EXPECT_EQ(plane(image, "depth.Z"), plane(usual, "depth.Z"));
}

/// The variance of the mean of 8 passes is 1/8 of that of one pass: of many seeds' pictures it is
/// what their spread shows.
TEST(Layers, SlowVarianceIsThatOfThePicture) {
  double stated = 0, shown = 0;
  std::vector<Image> images;
  for (int seed = 1; seed <= 12; ++seed) {
    images.push_back(render(sunlit_cloud({"layer.0.name=variance", "render.estimator=path",
                                          "render.seed=" + std::to_string(seed)}))
                         .image);
    stated += mean(plane(images.back(), "variance.G")) / 12;
  }
  for (std::size_t i = 0; i < plane(images[0], "G").size(); ++i) {
    double sum = 0, squares = 0;
    for (const Image& image : images) {
      const double value = plane(image, "G")[i];
      sum += value;
      squares += value * value;
    }
    shown += (squares - sum * sum / 12) / 11 / static_cast<double>(plane(images[0], "G").size());
  }
  // 576 pixels with 11 degrees of freedom each; a tenth is more than three standard errors of
  // both unless single pixels rule, which they do not here.
  EXPECT_NEAR(stated, shown, 0.15 * shown);
}

TEST(Layers, CompressionOfTheFile) {
  const test::TempFolder folder;
  for (const char* name : {"zip", "piz", "none", "zips", "rle"}) {
    Scene scene = sunlit_cloud({std::string("image.compression=") + name, "render.passes=1"});
    Image image = render(scene).image;
    image.metadata["vdbeam:compression"] = name;
    write_exr(image, folder.file("a.exr"));
    const Image read = read_image(folder.file("a.exr"));
    EXPECT_EQ(plane(read, "depth.Z"), plane(image, "depth.Z")) << name;
  }
}

TEST(Layers, NamesTheMistake) {
  EXPECT_EQ(error_of({"layer.0.name=shadows"}),
            "layer.0.name must be beauty, alpha, volume, volume_direct, volume_indirect, "
            "volume_emission, depth, background, transmittance, variance, error, samples, lights, "
            "volumes, cryptomatte, depth_near, depth_far, position, motion, density_gradient, "
            "denoising_albedo, denoising_normal, holdout, shadow, catcher_light or volume_volume0, "
            "got \"shadows\"; did you mean shadow?");
  EXPECT_EQ(error_of({"layer.0.name=depth", "layer.1.name=depth"}),
            "layer.1.name must not be there twice, got \"depth\"");
  EXPECT_EQ(
      error_of({"light.0.group=a-b"}),
      "light.0.group must be made of letters, digits and _, and not be \"rest\", got \"a-b\"");
  EXPECT_EQ(error_of({"light.0.group=a", "render.clamp=3"}),
            "render.clamp excludes groups of lights (light.group, mesh.group)");
}

} // namespace
} // namespace vdbeam
