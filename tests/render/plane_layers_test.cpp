// Layers of a ground without an end, with each camera.
#include "film/cryptomatte.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <numbers>
#include <ostream>

namespace vdbeam {
namespace {

constexpr int width = 24, height = 16;

/// A camera at a height of 3 over the ground y = 0, and the distance to the ground along the ray
/// through a place of the image, in pixels from the left and the top. Below 0: there is no ground.
struct View {
  std::string name, keys;
  std::function<double(double column, double row)> depth;
};

const View views[] = {
    {"perspective", "position = [0, 3, 9]\nlook_at = [0, 3, 0]\nfov = 40\n",
     [](double column, double row) {
       const double half = std::tan(std::numbers::pi / 9);
       const double down = (2 * row / height - 1) * half;
       const double side = (2 * column / width - 1) * half * width / height;
       return 3 / down * std::sqrt(1 + down * down + side * side);
     }},
    {"orthographic",
     "position = [0, 3, 9]\nlook_at = [0, 0, 6]\nprojection = 'orthographic'\nview_height = 4\n",
     [](double, double row) { return 3 * std::numbers::sqrt2 + 2 * (1 - 2 * row / height); }},
    {"panorama", "position = [0, 3, 9]\nlook_at = [0, 3, 0]\nprojection = 'panorama'\n",
     [](double, double row) {
       return 3 / std::sin((2 * row / height - 1) * std::numbers::pi / 2);
     }}};

/// What a failure prints.
void PrintTo(const View& view, std::ostream* out) {
  *out << view.name;
}

class PlaneLayers : public testing::TestWithParam<std::tuple<const char*, View>> {
protected:
  /// A ground of this material under a sky, and what else `text` says.
  Image image_of(const std::string& material, const std::string& text, int passes = 2) {
    const auto& [estimator, view] = GetParam();
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = " << width << "\nheight = " << height << "\ncryptomatte = true\n"
        << "[camera]\n"
        << view.keys << "[render]\nphotons = 4000\n"
        << "[[mesh]]\nname = 'ground'\ntype = 'plane'\nrotate = [-90, 0, 0]\nmaterial = { type = '"
        << material << "' }\n"
        << text;
    return render(load_scene(folder_.file("s.toml"), 1,
                             {"render.passes=" + std::to_string(passes),
                              std::string("render.estimator=") + estimator, "layer.0.name=depth",
                              "layer.1.name=catcher_light", "layer.2.name=shadow",
                              "layer.1.precision=float", "layer.3.name=alpha",
                              "layer.4.name=cryptomatte"}))
        .image;
  }
  static double at(const Image& image, const std::string& name, int x, int y) {
    const ImageChannel* channel = image.find(name);
    if (!channel)
      throw FrameError("no channel " + name);
    return static_cast<double>(channel->data[static_cast<std::size_t>(y * width + x)]);
  }
  static double coverage(const Image& image, const std::string& object, int x, int y) {
    double sum = 0;
    for (const char* layer : {"CryptoObject00.", "CryptoObject01.", "CryptoObject02."})
      for (const auto& [id, share] : {std::pair{"R", "G"}, {"B", "A"}})
        if (static_cast<float>(at(image, std::string(layer) + id, x, y)) == object_id(object))
          sum += at(image, std::string(layer) + share, x, y);
    return sum;
  }

  test::TempFolder folder_;
};

const std::string sky = "[[light]]\ntype = 'environment'\nradiance = [1, 1, 1]\n";

/// Depths lie between those at the pixel's corners; Cryptomatte covers all of it.
TEST_P(PlaneLayers, DepthAndCryptomatteUpToTheHorizon) {
  const View& view = std::get<1>(GetParam());
  const Image image = image_of("diffuse", sky);
  int seen = 0;
  for (int y = 0; y < height; ++y)
    for (const int x : {0, 11, 23}) {
      const auto [near, far] = std::minmax(
          {view.depth(x, y), view.depth(x + 1, y), view.depth(x, y + 1), view.depth(x + 1, y + 1)});
      const bool ground = near > 0 && std::isfinite(far), sky_alone = far < 0;
      if (!ground && !sky_alone) // the horizon
        continue;
      const double depth = at(image, "depth.Z", x, y);
      EXPECT_GE(depth, ground ? near * (1 - 1e-4) : 1e10) << x << " " << y;
      EXPECT_LE(depth, ground ? far * (1 + 1e-4) : 1.001e10) << x << " " << y;
      EXPECT_NEAR(coverage(image, "ground", x, y), ground ? 1 : 0, 1e-4) << x << " " << y;
      seen += ground;
    }
  EXPECT_GE(seen, 3 * (height / 2 - 1));
}

/// A ground that is held out hides what is below it, and leaves nothing of itself.
TEST_P(PlaneLayers, HoldoutsHideAndHaveNoAlpha) {
  const std::string balls = "[[mesh]]\nname = 'below'\ntype = 'sphere'\nscale = 500\n"
                            "translate = [0, -501, 0]\n";
  const Image image = image_of("holdout", sky + balls);
  for (int y = height / 2 + 1; y < height; ++y)
    for (const int x : {0, 11, 23}) {
      EXPECT_EQ(at(image, "A", x, y), 0) << x << " " << y;
      EXPECT_EQ(coverage(image, "below", x, y), 0) << x << " " << y;
    }
}

/// The light of fire on a catcher is a layer of its own: with the fire it makes the render of all,
/// but for what is held out.
TEST_P(PlaneLayers, FireLightsTheCatcher) {
  const std::string fire =
      "[[volume]]\nshape = 'sphere'\nextinction = 0.5\nalbedo = 0\ntranslate = [0, 1.5, 5]\n"
      "emission = { intensity = 'density', scale = 3, color = [1, 0.5, 0.2] }\n";
  const Image element = image_of("shadow_catcher", fire, 64), all = image_of("diffuse", fire, 64);
  for (const std::string c : {"R", "G", "B"}) {
    double sum = 0, expected = 0, added = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double light = at(element, "catcher_light." + c, x, y);
        sum += at(element, c, x, y) + light;
        expected += at(all, c, x, y);
        added += light;
      }
    EXPECT_NEAR(sum, expected, 0.03 * expected) << c;
    EXPECT_GT(added, 0.004 * expected) << c;
  }
  const std::string wall =
      "[[mesh]]\ntype = 'quad'\nscale = 100\ntranslate = [0, 0, 8]\nmaterial = "
      "{ type = 'holdout' }\n";
  const Image behind = image_of("shadow_catcher", fire + wall, 4);
  EXPECT_EQ(at(behind, "catcher_light.R", 12, 9), 0);
}

INSTANTIATE_TEST_SUITE_P(Cameras, PlaneLayers,
                         testing::Combine(testing::Values("beam", "path"),
                                          testing::ValuesIn(views)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" +
                                  std::get<1>(test.param).name;
                         });

} // namespace
} // namespace vdbeam
