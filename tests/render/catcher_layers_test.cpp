// Shadow catchers in colour: plate times shadow, and light that the plate does not have.
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>

namespace vdbeam {
namespace {

class CatcherLayers : public testing::TestWithParam<const char*> {
protected:
  CatcherLayers() {
    VolumeOptions options;
    options.size = 16;
    write_volume("box", folder_.file("box.vdb"), options);
  }
  /// A coloured ground in a sun and a blue sky, and what else `text` says.
  Image image_of(const std::string& ground, const std::string& text, int passes) {
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 32\nheight = 24\n"
           "[camera]\nposition = [0, 3, 9]\nlook_at = [0, -0.3, 0]\nfov = 34\n"
           "[render]\nphotons = 20000\n"
           "[[light]]\ntype = 'distant'\ndirection = [0.5, -1, -0.3]\nirradiance = [1.6, 1.3, "
           "0.9]\n"
           "angular_radius = 1\n"
           "[[light]]\ntype = 'environment'\nradiance = [0.1, 0.15, 0.3]\nvisible = false\n"
           "[[mesh]]\ntype = 'plane'\nrotate = [-90, 0, 0]\ntranslate = [0, -1.2, 0]\n"
        << "material = { type = '" << ground << "', albedo = [0.5, 0.4, 0.3] }\n"
        << text;
    return render(load_scene(folder_.file("s.toml"), 1,
                             {"render.passes=" + std::to_string(passes),
                              std::string("render.estimator=") + GetParam(), "layer.0.name=shadow",
                              "layer.1.name=catcher_light", "layer.0.precision=float",
                              "layer.1.precision=float"}))
        .image;
  }
  static constexpr int rows = 4, columns = 4;
  using Regions = std::array<double, rows * columns>;
  /// Means over the picture's regions of a value of pixels.
  template <class Value>
  static Regions regions(const Image& image, const Value& value) {
    Regions means{};
    const int width = image.width / columns, height = image.height / rows;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        means[static_cast<std::size_t>(y / height * columns + x / width)] +=
            value(static_cast<std::size_t>(y * image.width + x)) / (width * height);
    return means;
  }
  static const std::vector<float>& plane(const Image& image, const std::string& name) {
    const ImageChannel* channel = image.find(name);
    if (!channel)
      throw FrameError("no channel " + name);
    return channel->data;
  }
  /// The ground alone, the same in every test of an estimator.
  const Image& bare_ground() {
    static std::map<std::string, Image> images;
    const auto [found, is_new] = images.try_emplace(GetParam());
    if (is_new)
      found->second = image_of("diffuse", "", 128);
    return found->second;
  }
  /// The element, where plate * shadow + beauty + catcher_light is what a render of all shows.
  Image expect_comp(const std::string& others, int passes, double least_added) {
    const Image element = image_of("shadow_catcher", others, passes);
    const Image all = image_of("diffuse", others, passes);
    const Image& bare = bare_ground();
    double added = 0;
    for (const std::string c : {"R", "G", "B"}) {
      const std::vector<float>&beauty = plane(element, c), &left = plane(element, "shadow." + c),
            &light = plane(element, "catcher_light." + c), &plate = plane(bare, c),
            &whole = plane(all, c);
      const Regions composited = regions(element, [&](std::size_t i) {
        return static_cast<double>(plate[i] * left[i] + beauty[i] + light[i]);
      });
      const Regions wanted = regions(all, [&](std::size_t i) { return double{whole[i]}; });
      for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_NEAR(composited[i], wanted[i], 0.002) << c << ", region " << i;
      for (const float value : light)
        added += static_cast<double>(value) / static_cast<double>(light.size() * 3);
    }
    EXPECT_GE(added, least_added);
    return element;
  }

  test::TempFolder folder_;
};

/// The shadow of a black ball, bluer than the ground in the sun.
TEST_P(CatcherLayers, TheShadowHasTheColourOfWhatIsLeft) {
  const std::string ball = "[[mesh]]\ntype = 'sphere'\nmaterial = { albedo = 0 }\n";
  const Image element = expect_comp(ball, 128, 0);
  double least_red = 1, least_blue = 1;
  for (std::size_t i = 0; i < element.find("R")->data.size(); ++i) {
    if (element.find("shadow.R")->data[i] == 0) // the ball itself
      continue;
    least_red = std::min(least_red, double{element.find("shadow.R")->data[i]});
    least_blue = std::min(least_blue, double{element.find("shadow.B")->data[i]});
  }
  EXPECT_LT(least_red, 0.7 * least_blue);
}

/// Smoke whose extinction is chromatic, a red ball, and a lamp: each sends light to the ground.
TEST_P(CatcherLayers, TheGroundInARenderOfAllIsTheComp) {
  expect_comp("[[volume]]\nfile = 'box.vdb'\nextinction = 1.2\nextinction_scale = [1, 0.8, 0.6]\n"
              "translate = [-0.6, 0.4, 0]\nalbedo = 0.8\n"
              "[[mesh]]\ntype = 'sphere'\nscale = 0.6\ntranslate = [1.2, -0.5, 0.5]\n"
              "material = { albedo = [0.8, 0.2, 0.1] }\n"
              "[[mesh]]\ntype = 'sphere'\nscale = 0.3\ntranslate = [2.2, -0.4, -1]\n"
              "material = { type = 'emissive', radiance = [2, 1, 0.5] }\n",
              std::string(GetParam()) == "path" ? 512 : 256, 0.003);
}

INSTANTIATE_TEST_SUITE_P(Estimators, CatcherLayers, testing::Values("beam", "path"),
                         [](const auto& test) { return std::string(test.param); });

} // namespace
} // namespace vdbeam
