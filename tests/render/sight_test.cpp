#include "render/sight.h"

#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vdbeam {
namespace {

RenderResult render_with(const std::vector<std::string>& more) {
  std::vector<std::string> overrides{"image.width=24", "image.height=14", "render.photons=1000",
                                     "render.passes=1", "render.estimator=path"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return render(load_scene(VDBEAM_SOURCE_DIR "/data/cloud.toml", 1, overrides));
}

std::string notes_of(const RenderResult& result) {
  std::string text;
  for (const std::string& note : result.notes)
    text += note + "\n";
  return text;
}

TEST(Sight, ReportsTheOpticalDepth) {
  const RenderResult usual = render_with({});
  EXPECT_GT(usual.picture.optical_depth, 1);
  EXPECT_GT(usual.picture.opacity, 0.05);
  EXPECT_LT(usual.picture.opacity, 1);
  const RenderResult denser = render_with({"volume.0.extinction_scale=[1, 1, 2]"});
  EXPECT_NEAR(denser.picture.optical_depth / usual.picture.optical_depth, 2, 1e-5);
}

TEST(Sight, NotesAMediumThatNobodySees) {
  const RenderResult thin = render_with({"volume.0.extinction=0.0001"});
  EXPECT_NE(notes_of(thin).find("the medium is nearly invisible: its optical depth is"),
            std::string::npos)
      << notes_of(thin);
  const RenderResult far = render_with({"camera.far=0.01"});
  EXPECT_NE(notes_of(far).find("camera.far = 0.01 clips every volume"), std::string::npos)
      << notes_of(far);
  const RenderResult inside = render_with({"mesh.0={type=\"sphere\", scale=1000}"});
  EXPECT_NE(notes_of(inside).find("the camera is inside mesh.0"), std::string::npos)
      << notes_of(inside);
}

TEST(Sight, NotesBlackAndGlaringPictures) {
  const auto dark = render_with({"light.0.irradiance=0", "light.1.radiance=0"});
  EXPECT_EQ(dark.picture.black, 1);
  EXPECT_NE(notes_of(dark).find("the image is black"), std::string::npos) << notes_of(dark);
  const auto bright = render_with({"light.0.irradiance=100000", "light.1.radiance=100000"});
  EXPECT_GT(bright.picture.over_one, 0.5);
  EXPECT_NE(notes_of(bright).find("% of the image is above 1"), std::string::npos)
      << notes_of(bright);
  const auto usual = render_with({});
  EXPECT_EQ(notes_of(usual), "");
}

/// Which layers a file has says nothing of the opacity.
TEST(Sight, KnowsNoOpacityWithoutAlpha) {
  Image image;
  image.width = image.height = 1;
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, {0.5f}});
  EXPECT_TRUE(std::isnan(picture_facts(image, {}).opacity));
  image.channels.push_back({"A", {0.25f}});
  EXPECT_EQ(picture_facts(image, {}).opacity, 0.25);
}

} // namespace
} // namespace vdbeam
