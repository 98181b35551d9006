// Extremes of a shot's camera and motion: velocities of 1e6, lenses of no width and wider than all
// that they see.
#include "support/ball_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbeam {
namespace {

/// The ball, which loses no light, in a sky of radiance 1.
class Shots : public test::BallTest {
protected:
  RenderResult render_with(const std::vector<std::string>& more) {
    std::vector<std::string> overrides{"volume.0.extinction=2", "volume.0.velocity_fps=24",
                                       "light.0.visible=true"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return render(load_ball("position = [0, 0, 6]\n", overrides));
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
  static void expect_finite(const Image& image) {
    for (const ImageChannel& channel : image.channels)
      for (const float value : channel.data)
        ASSERT_TRUE(std::isfinite(value)) << channel.name;
  }
};

/// With a lens far wider than its focus is distant, rays of neighbouring pixels come from all
/// sides.
TEST_F(Shots, LensesWiderThanTheirFocusLoseNoLight) {
  for (const char* radius : {"20", "100", "10000"}) {
    SCOPED_TRACE(radius);
    const RenderResult result =
        render_with({std::string("camera.lens_radius=") + radius, "render.estimator=beam"});
    const std::vector<float>& values = result.image.find("R")->data;
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    EXPECT_NEAR(mean, 1, 0.01); // kernels reach beyond the ball
  }
}

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

/// A third of the voxels have a velocity that is not finite, infinite or 1e6: a note counts them,
/// and the layer shows how those around them move.
TEST_F(Shots, WildVelocitiesInTheMotionLayer) {
  write("wild", "wild.vdb");
  const std::string file = "volume.0.file=" + folder_.file("wild.vdb");
  for (const char* shutter : {"camera.shutter_close=0", "camera.shutter_close=0.5"}) {
    SCOPED_TRACE(shutter);
    const RenderResult result = render_with({"layer.0.name=motion", file, shutter});
    expect_finite(result.image);
    expect_one(result.image);
    EXPECT_EQ(std::count_if(result.notes.begin(), result.notes.end(),
                            [](const std::string& note) {
                              return note.find("voxels have a velocity that is not finite") !=
                                     std::string::npos;
                            }),
              1);
    const Image tame = render_with({"layer.0.name=motion", shutter}).image;
    const std::size_t middle = 12 * 24 + 12;
    for (const char* channel : {"motion.X", "motion.Y"})
      EXPECT_NEAR(plane(result.image, channel)[middle], plane(tame, channel)[middle],
                  1e-4f * plane(tame, channel)[middle]);
  }
}

/// Velocities and frame rates beyond all measure are not to be trusted either.
TEST_F(Shots, ExtremeFactorsInTheMotionLayer) {
  for (const char* extreme :
       {"volume.0.velocity_scale=1e6", "volume.0.velocity_scale=-1e30",
        "volume.0.velocity_scale=1e308", "volume.0.velocity_scale=1e-308",
        "volume.0.velocity_fps=1e-300", "volume.0.velocity_fps=1e-6", "volume.0.velocity_fps=1e300",
        "volume.0.velocity_scale=20", "camera.fov=179.9"})
    for (const char* shutter : {"camera.shutter_close=0", "camera.shutter_close=0.5"}) {
      SCOPED_TRACE(std::string(extreme) + " " + shutter);
      const Image image =
          render_with({"layer.0.name=motion", "render.passes=2", extreme, shutter}).image;
      expect_finite(image);
    }
}

TEST_F(Shots, ShutterOfNoLength) {
  const Image still = render_with({}).image;
  EXPECT_TRUE(
      same(still, render_with({"camera.shutter_open=0.5", "camera.shutter_close=0.5"}).image));
  // The shortest shutter that numbers resolve gives a still image.
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
