// Extremes of a shot's camera and motion: velocities of 1e6, lenses of no width and wider than all
// that they see.
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"

#include "support/temp_folder.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

namespace vdbeam {
namespace {

/// A ball with a velocity of (1, 2, 3) that loses no light, in a sky of radiance 1.
class Shots : public ::testing::Test {
protected:
  Shots() {
    VolumeOptions options;
    options.size = 24;
    write_volume("staggered", folder_.file("ball.vdb"), options);
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 24\nheight = 24\n[camera]\nposition = [0, 0, 6]\n"
           "[[volume]]\nfile = \"ball.vdb\"\nextinction = 2\n"
           "[[light]]\ntype = \"environment\"\n[render]\npasses = 16\nestimator = \"path\"\n";
  }
  RenderResult render_with(const std::vector<std::string>& more) {
    return render(load_scene(folder_.file("s.toml"), 1, more));
  }
  static bool same(const Image& a, const Image& b) {
    const std::vector<float>&x = a.find("R")->data, &y = b.find("R")->data;
    return std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
  }
  /// The furnace: every ray sees radiance 1.
  static void expect_one(const Image& image) {
    double sum = 0, squares = 0;
    const std::vector<float>& values = image.find("R")->data;
    for (const float value : values) {
      ASSERT_TRUE(std::isfinite(value));
      sum += static_cast<double>(value);
      squares += static_cast<double>(value) * static_cast<double>(value);
    }
    const auto n = static_cast<double>(values.size());
    const double mean = sum / n, error = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, 1, 4.5 * error + 1e-5);
    EXPECT_LT(error, 0.01);
  }

  test::TempFolder folder_;
};

TEST_F(Shots, VelocitiesOf1e6) {
  for (const char* scale : {"1e6", "-1e6", "1e30", "1e3", "-1e2"}) {
    SCOPED_TRACE(scale);
    expect_one(
        render_with({"camera.shutter_close=0.5", std::string("volume.0.velocity_scale=") + scale})
            .image);
  }
  // What would cross the whole grid within a frame is not to be trusted, and stays where it is.
  const Image still = render_with({"camera.shutter_close=0.5", "volume.0.velocity=none"}).image,
              wild = render_with({"camera.shutter_close=0.5", "volume.0.velocity_scale=1e6"}).image;
  for (std::size_t i = 0; i < still.find("A")->data.size(); ++i)
    EXPECT_NEAR(wild.find("A")->data[i], still.find("A")->data[i], 1e-5f) << i;
}

TEST_F(Shots, ShutterOfNoLength) {
  const Image still = render_with({}).image;
  EXPECT_TRUE(
      same(still, render_with({"camera.shutter_open=0.5", "camera.shutter_close=0.5"}).image));
  // The shortest that numbers can tell is as good as still.
  expect_one(render_with({"camera.shutter_close=1e-300"}).image);
}

TEST_F(Shots, LensesOfNoWidthAndWiderThanTheVolume) {
  EXPECT_TRUE(same(render_with({}).image, render_with({"camera.lens_radius=0"}).image));
  for (const char* radius : {"1e-30", "10", "1e6", "1e30"}) {
    SCOPED_TRACE(radius);
    const Image image = render_with({std::string("camera.lens_radius=") + radius}).image;
    expect_one(image);
  }
}

} // namespace
} // namespace vdbeam
