#include "prepare/prepared_scene.h"
#include "support/image_checks.h"
#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <cstring>

// The sample fire, from its scene file to the developed image.
namespace vdbeam {
namespace {

using test::expect_same_pixels;

Scene small_fire(int frame, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"image.width=24", "image.height=24", "render.photons=2000",
                                     "render.passes=4"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return load_scene(VDBEAM_SOURCE_DIR "/data/fire.toml", frame, overrides);
}

double mean(const Image& image, const std::string& channel) {
  double sum = 0;
  for (const float value : image.find(channel)->data)
    sum += static_cast<double>(value);
  return sum / static_cast<double>(image.find(channel)->data.size());
}

TEST(SampleFire, EmissionIsAnOutputOfItsOwn) {
  const Image image = render(small_fire(14)).image;
  EXPECT_GT(mean(image, "volume_emission.R"), 0.05);
  EXPECT_GT(mean(image, "volume_emission.R"), 2 * mean(image, "volume_emission.G"));
  for (const std::string c : {"R", "G", "B"})
    EXPECT_NEAR(mean(image, "volume." + c),
                mean(image, "volume_direct." + c) + mean(image, "volume_indirect." + c) +
                    mean(image, "volume_emission." + c),
                1e-5);
  // The fire lights its smoke: without bounces of its own light there is less.
  const Image dark = render(small_fire(14, {"volume.0.emission.scale=0"})).image;
  EXPECT_GT(mean(image, "volume_indirect.R"), 2 * mean(dark, "volume_indirect.R"));
  EXPECT_EQ(mean(dark, "volume_emission.R"), 0); // but the channel is there, as in other frames
}

/// A frame in which the flame's grid is empty.
TEST(SampleFire, FrameInWhichTheFireIsOut) {
  const RenderResult result = render(small_fire(18));
  EXPECT_FALSE(result.plan.needs(Stage::emission));
  EXPECT_EQ(mean(result.image, "volume_emission.R"), 0);
  EXPECT_GT(mean(result.image, "volume.A"), 0.05);
  const Image only = render(small_fire(18, {"volume.0.extinction=0", "light.0.irradiance=0",
                                            "light.1.radiance=0"}))
                         .image;
  EXPECT_EQ(mean(only, "R"), 0);
}

TEST(SampleFire, PartsMergeToTheWhole) {
  const test::TempFolder folder;
  const Image whole = render(small_fire(14)).image;
  const auto parts = test::render_parts(small_fire(14), folder, {{0, 0}, {1, 3}});
  expect_same_pixels(merge_partials(parts), whole);
}

TEST(SampleFire, GridsAreKeptFromFrameToFrame) {
  const PreparedScenePtr first = prepare_scene(small_fire(14));
  // A flickering strength needs no reading, another temperature does.
  const PreparedScenePtr second =
      prepare_scene(small_fire(14, {"volume.0.emission.scale=7"}), first);
  EXPECT_EQ(second->world->medium.emitters[0].field, first->world->medium.emitters[0].field);
  EXPECT_NE(second->world->medium.emitters[0].strength, first->world->medium.emitters[0].strength);
  const PreparedScenePtr third =
      prepare_scene(small_fire(14, {"volume.0.emission.kelvin=800"}), first);
  EXPECT_NE(third->world->medium.emitters[0].field, first->world->medium.emitters[0].field);
  expect_same_pixels(render(small_fire(14, {"volume.0.emission.scale=7"}), second).image,
                     render(small_fire(14, {"volume.0.emission.scale=7"})).image);
}

/// No grid is read that the frame does not need: a file that lacks it renders.
TEST(SampleFire, ReadsOnlyWhatItNeeds) {
  const test::TempFolder folder;
  const std::string path = folder.file("flame.vdb");
  VolumeOptions options;
  options.size = 16;
  options.name = "flame";
  write_volume("noise", path, options);
  const std::vector<std::string> flame_only{
      "volume.0.file=" + path, "volume.0.emission.temperature=\"\"", "volume.0.translate=[3,3,2]"};
  const auto with = [&](const std::string& more) {
    std::vector<std::string> all = flame_only;
    all.push_back(more);
    return small_fire(14, all);
  };
  EXPECT_THROW(render(with("volume.0.extinction=1")), InputError); // there is no density
  EXPECT_GT(mean(render(with("volume.0.extinction=0")).image, "volume_emission.R"), 0);
  try {
    render(small_fire(14, {"volume.0.file=" + path, "volume.0.extinction=0"}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("flame.vdb: has no grid \"temperature\"; it holds \"flame\""),
              std::string::npos)
        << error.what();
  }
  // What does not glow is not looked for.
  EXPECT_NO_THROW(render(small_fire(
      14, {"volume.0.file=" + path, "volume.0.density=flame", "volume.0.emission.scale=0"})));
}

} // namespace
} // namespace vdbeam
