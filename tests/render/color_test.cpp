#include "image/color_conversion.h"
#include "image/output_formats.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace vdbeam {
namespace {

Image picture(const char* file, std::vector<std::string> overrides) {
  overrides.insert(overrides.end(), {"image.width=24", "image.height=14", "render.passes=2",
                                     "render.estimator=path"});
  return render(load_scene(std::string(VDBEAM_SOURCE_DIR "/data/") + file, 14, overrides)).image;
}

void expect_same_colors(const Image& a, const Image& b, double tolerance) {
  for (const char* name : {"R", "G", "B"}) {
    const std::vector<float>&x = a.find(name)->data, &y = b.find(name)->data;
    double sum = 0;
    for (const float value : y)
      sum += static_cast<double>(value) / static_cast<double>(y.size());
    EXPECT_GT(sum, 0);
    for (std::size_t i = 0; i < x.size(); ++i)
      ASSERT_NEAR(x[i], y[i], tolerance * (std::abs(static_cast<double>(y[i])) + sum)) << name;
  }
}

/// Light is linear: where nothing has a colour but the lights, it does not matter in which space it
/// is rendered.
TEST(Color, LightsOfAWhiteMediumAreTheSameInEverySpace) {
  const std::vector<std::string> white{"volume.0.albedo=0.99"};
  const Image expected = picture("sunlit_cloud.toml", white);
  for (const char* space : {"acescg", "rec2020", "aces2065_1"}) {
    std::vector<std::string> overrides = white;
    overrides.push_back(std::string("image.working_space=") + space);
    Image image = picture("sunlit_cloud.toml", overrides);
    EXPECT_FALSE(image.primaries->is_near({}));
    convert_colors(image, {});
    expect_same_colors(image, expected, 2e-5);
  }
}

/// A fire too red for Rec.709 is as bright in a space that can show it.
TEST(Color, FireIsAsBright) {
  const Image expected = picture("fire.toml", {"volume.0.extinction=0"});
  Image image = picture("fire.toml", {"volume.0.extinction=0", "image.working_space=rec2020"});
  convert_colors(image, {});
  const auto luminance = [](const Image& of, std::size_t i) {
    return 0.2126729f * of.find("volume.R")->data[i] + 0.7151522f * of.find("volume.G")->data[i] +
           0.0721750f * of.find("volume.B")->data[i];
  };
  double sum = 0;
  for (std::size_t i = 0; i < image.find("R")->data.size(); ++i) {
    ASSERT_NEAR(luminance(image, i), luminance(expected, i), 1e-3 * luminance(expected, i) + 1e-6);
    sum += static_cast<double>(luminance(expected, i));
  }
  EXPECT_GT(sum, 1);
}

class ColorFiles : public testing::Test {
protected:
  Image sample() {
    Image image;
    image.width = 2;
    image.height = 1;
    image.channels = {{"R", {0.5f, 1}, false},
                      {"G", {0.25f, 1}, false},
                      {"B", {0.125f, 1}, false},
                      {"A", {1, 1}, false}};
    return image;
  }
  test::TempFolder folder_;
};

TEST_F(ColorFiles, ChromaticitiesGoWithThePicture) {
  Image image = sample();
  image.metadata["vdbeam:outputSpace"] = "acescg";
  write_image(image, folder_.file("a.exr"));
  Image read = read_image(folder_.file("a.exr"));
  ASSERT_TRUE(read.primaries);
  EXPECT_TRUE(read.primaries->is_near(chromaticities_of(ColorSpace::acescg)));
  EXPECT_GT(std::abs(read.find("R")->data[0] - 0.5f), 0.05f);
  convert_colors(read, {});
  for (const char* name : {"R", "G", "B", "A"})
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(read.find(name)->data[i], image.find(name)->data[i], 1e-5);
}

/// A sky in ACEScg lights the scene as the same sky in Rec.709 does.
TEST_F(ColorFiles, SkiesAreConverted) {
  Image sky;
  sky.width = 8;
  sky.height = 4;
  for (const auto& [name, value] : {std::pair{"R", 0.9f}, {"G", 0.5f}, {"B", 0.3f}})
    sky.channels.push_back({name, std::vector<float>(32, value), false});
  write_exr(sky, folder_.file("rec709.exr"));
  convert_colors(sky, chromaticities_of(ColorSpace::acescg));
  write_exr(sky, folder_.file("acescg.exr"));
  const auto lit_by = [&](const char* file) {
    return picture("cloud.toml", {"light.1.image=" + folder_.file(file)});
  };
  expect_same_colors(lit_by("acescg.exr"), lit_by("rec709.exr"), 1e-4);
}

TEST_F(ColorFiles, OutputSpacesOfAConfiguration) {
  std::ofstream(folder_.file("config.ocio"))
      << "ocio_profile_version: 2\nroles:\n  aces_interchange: ap0\n  default: ap0\n"
         "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
         "displays:\n  d:\n    - !<View> {name: v, colorspace: ap0}\n"
         "colorspaces:\n  - !<ColorSpace>\n    name: ap0\n"
         "  - !<ColorSpace>\n    name: half\n    from_scene_reference: !<MatrixTransform> "
         "{matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}\n";
  ::setenv("OCIO", folder_.file("config.ocio").c_str(), 1);
  Image image = sample();
  image.metadata["vdbeam:outputSpace"] = "half";
  write_image(image, folder_.file("h.exr"));
  const Image read = read_image(folder_.file("h.exr"));
  EXPECT_EQ(read.metadata.at("vdbeam:colorSpace"), "half");
  Image expected = sample();
  convert_colors(expected, chromaticities_of(ColorSpace::aces2065_1));
  for (const char* name : {"R", "G", "B"})
    EXPECT_NEAR(read.find(name)->data[0], 0.5f * expected.find(name)->data[0], 1e-6);
  EXPECT_EQ(why_no_output_space("half"), "");
  EXPECT_NE(why_no_output_space("third").find("must be a colour space of"), std::string::npos);
  ::unsetenv("OCIO");
  EXPECT_NE(why_no_output_space("half").find("environment variable OCIO"), std::string::npos);
}

} // namespace
} // namespace vdbeam
