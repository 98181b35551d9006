#include "support/render_parts.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"
#include "vdbeam/render.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace vdbeam {
namespace {

/// One or two volumes before a camera with parallel rays, four pixels to the world unit.
class RayLayersTest : public testing::Test {
protected:
  RayLayersTest() {
    VolumeOptions options;
    options.size = 32;
    for (const char* kind : {"box", "ramp", "staggered"})
      write_volume(kind, folder_.file(std::string(kind) + ".vdb"), options);
  }
  Scene load(const std::string& text, const std::vector<std::string>& more = {}) {
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 24\nheight = 16\n"
           "[camera]\nposition = [0, 0, 10]\nprojection = \"orthographic\"\nview_height = 4\n"
           "[render]\npasses = 4\nphotons = 2000\nestimator = \"path\"\n"
           "[[light]]\ntype = \"environment\"\nvisible = false\n"
        << text;
    return load_scene(folder_.file("s.toml"), 1, more);
  }
  static const std::vector<float>& plane(const Image& image, const std::string& name) {
    const ImageChannel* channel = image.find(name);
    if (!channel)
      throw FrameError("no channel " + name);
    return channel->data;
  }
  static double at(const Image& image, const std::string& name, int x, int y) {
    return static_cast<double>(plane(image, name)[static_cast<std::size_t>(y * image.width + x)]);
  }
  static std::vector<std::string> layers(const std::vector<std::string>& names) {
    std::vector<std::string> overrides;
    for (const std::string& name : names)
      overrides.push_back("layer." + std::to_string(overrides.size()) + ".name=" + name);
    return overrides;
  }

  test::TempFolder folder_;
};

const std::string cube = "[[volume]]\nfile = \"box.vdb\"\nextinction = 3\n";

/// The first and the last hundredth of a ray's opacity lie before 1 and behind 99 % of it.
TEST_F(RayLayersTest, DepthsOfACube) {
  const Image image =
      render(load(cube, layers({"depth_near", "depth", "depth_far", "alpha"}))).image;
  const double opacity = at(image, "A", 12, 8);
  // The cube begins at 9, about; half a voxel is 1/32.
  const auto depth_of = [](double part) { return 9 - std::log1p(-part) / 3; };
  EXPECT_NEAR(at(image, "depth_near.Z", 12, 8), depth_of(0.01 * opacity), 0.04);
  EXPECT_NEAR(at(image, "depth_far.Z", 12, 8), depth_of(0.99 * opacity), 0.04);
  EXPECT_LT(at(image, "depth_near.Z", 12, 8), at(image, "depth.Z", 12, 8));
  EXPECT_LT(at(image, "depth.Z", 12, 8), at(image, "depth_far.Z", 12, 8));
  EXPECT_EQ(at(image, "depth_near.Z", 0, 0), 1e10);
  EXPECT_FALSE(image.find("depth_far.Z")->half);
}

TEST_F(RayLayersTest, DepthsReachASurface) {
  const std::string wall = "[[mesh]]\ntype = \"quad\"\nscale = 5\ntranslate = [0, 0, -4]\n";
  const Image image = render(load(cube + wall, layers({"depth_near", "depth_far"}))).image;
  EXPECT_NEAR(at(image, "depth_near.Z", 0, 0), 14, 1e-4);
  EXPECT_NEAR(at(image, "depth_far.Z", 0, 0), 14, 1e-4);
  EXPECT_NEAR(at(image, "depth_near.Z", 12, 8), 9, 0.05);
}

TEST_F(RayLayersTest, PositionIsThatOfTheDepth) {
  const Image image = render(load(cube, layers({"position", "depth"}))).image;
  EXPECT_NEAR(at(image, "position.Z", 14, 6), 10 - at(image, "depth.Z", 14, 6), 1e-5);
  EXPECT_NEAR(at(image, "position.X", 14, 6), (14.5 - 12) / 4, 0.125);
  EXPECT_NEAR(at(image, "position.Y", 14, 6), (8 - 6.5) / 4, 0.125);
  EXPECT_EQ(at(image, "position.X", 0, 0), 0);
}

/// The density rises from 0 to 1 over two units along x.
TEST_F(RayLayersTest, GradientOfARamp) {
  const Image image = render(load("[[volume]]\nfile = \"ramp.vdb\"\nextinction = 0.4\n",
                                  layers({"density_gradient"})))
                          .image;
  EXPECT_NEAR(at(image, "density_gradient.X", 12, 8), 0.4 * 0.5, 0.01);
  EXPECT_NEAR(at(image, "density_gradient.Y", 12, 8), 0, 1e-3);
}

/// The ball flies by (0.5, 1, 1.5) in a frame, the camera by 1 to the right: four pixels to the
/// unit.
TEST_F(RayLayersTest, MotionInPixels) {
  const std::string ball =
      "[[volume]]\nfile = \"staggered.vdb\"\nextinction = 2\nvelocity_fps = 2\n";
  const std::string pan = "camera.position={keys=[[1,[0,0,10]],[2,[1,0,10]]]}";
  const std::string aim = "camera.look_at={keys=[[1,[0,0,0]],[2,[1,0,0]]]}";
  const Image still = render(load(ball, layers({"motion"}))).image;
  EXPECT_NEAR(at(still, "motion.X", 12, 8), 2, 1e-3);
  EXPECT_NEAR(at(still, "motion.Y", 12, 8), 4, 1e-3);
  EXPECT_EQ(at(still, "motion.Y", 0, 0), 0);
  std::vector<std::string> more = layers({"motion"});
  more.insert(more.end(), {pan, aim});
  const Image panned = render(load(ball, more)).image;
  EXPECT_NEAR(at(panned, "motion.X", 12, 8), -2, 1e-3);
  EXPECT_NEAR(at(panned, "motion.Y", 12, 8), 4, 1e-3);
  more.push_back("camera.shutter_close=0.2"); // moves as far whenever it is seen
  EXPECT_NEAR(at(render(load(ball, more)).image, "motion.Y", 12, 8), 4, 1e-3);
  more.push_back("volume.0.velocity=none");
  more.push_back("volume.0.translate={keys=[[1,[0,0,0]],[2,[0,0.5,0]]]}");
  const Image placed = render(load(ball, more)).image;
  EXPECT_NEAR(at(placed, "motion.X", 12, 8), -4, 1e-3);
  EXPECT_NEAR(at(placed, "motion.Y", 12, 8), 2, 1e-3);
}

TEST_F(RayLayersTest, MotionOfAMesh) {
  const Image image = render(load("[[mesh]]\ntype = \"quad\"\n"
                                  "translate = { keys = [[1, [0, 0, 0]], [2, [0.25, -0.5, 1]]] }\n",
                                  layers({"motion"})))
                          .image;
  EXPECT_NEAR(at(image, "motion.X", 12, 8), 1, 1e-4);
  EXPECT_NEAR(at(image, "motion.Y", 12, 8), -2, 1e-4);
}

class LayersOfVolumes : public RayLayersTest, public testing::WithParamInterface<const char*> {};

const std::string two_volumes =
    "[[volume]]\nname = \"front\"\nfile = \"box.vdb\"\nextinction = 1\nalbedo = [0.9, 0.5, 0.2]\n"
    "phase = { type = \"henyey_greenstein\", g = 0.8 }\ntranslate = [0.5, 0, 0.7]\n"
    "[[volume]]\nname = \"back\"\nfile = \"ramp.vdb\"\nextinction_scale = [1, 0.8, 0.6]\n"
    "extinction = 2\nemission = { intensity = \"density\", color = [1, 0.4, 0.1] }\n"
    "[[light]]\ntype = \"distant\"\ndirection = [0, -1, -1]\n";

/// Overlapping volumes of several colours and phase functions, one of them emits light.
TEST_P(LayersOfVolumes, AddUpToTheVolume) {
  const std::string estimator = std::string("render.estimator=") + GetParam();
  const std::string names[] = {"layer.0.name=volumes", "layer.1.name=volume", "layer.2.name=alpha"};
  for (const char* more : {"render.direct=auto", "render.direct=photons", "light.0.group=sky",
                           "render.store=scatter"}) {
    const Image image =
        render(load(two_volumes, {estimator, names[0], names[1], names[2], more})).image;
    double part = 0, sum = 0;
    for (const char* channel : {"R", "G", "B"})
      for (std::size_t i = 0; i < plane(image, "volume.R").size(); ++i) {
        const double all = static_cast<double>(plane(image, std::string("volume.") + channel)[i]),
                     front = static_cast<double>(
                         plane(image, std::string("volume_front.") + channel)[i]),
                     back = static_cast<double>(
                         plane(image, std::string("volume_back.") + channel)[i]);
        ASSERT_NEAR(front + back, all, 2e-5 * (std::abs(all) + 0.01)) << channel << i << more;
        part += front;
        sum += all;
      }
    EXPECT_GT(part, 0.05 * sum);
    EXPECT_LT(part, 0.95 * sum);
    for (std::size_t i = 0; i < plane(image, "A").size(); ++i)
      ASSERT_NEAR(plane(image, "volume_front.A")[i] + plane(image, "volume_back.A")[i],
                  plane(image, "A")[i], 1e-5);
  }
}

/// A volume without light of its own and without albedo has a black layer.
TEST_P(LayersOfVolumes, ABlackOneIsBlack) {
  const Image image = render(load(two_volumes, {std::string("render.estimator=") + GetParam(),
                                                "volume.0.albedo=0", "layer.0.name=volumes"}))
                          .image;
  for (const float value : plane(image, "volume_front.G"))
    ASSERT_EQ(value, 0);
}

INSTANTIATE_TEST_SUITE_P(Estimators, LayersOfVolumes, testing::Values("beam", "march", "path"),
                         [](const auto& test) { return std::string(test.param); });

/// Opacity times albedo and normal, of the medium and of the surface behind it, without noise.
TEST_F(RayLayersTest, WhatGuidesDenoisers) {
  const std::string wall = "[[mesh]]\ntype = \"quad\"\nscale = 5\ntranslate = [0, 0, -4]\n"
                           "rotate = [0, 30, 0]\nmaterial = { albedo = [0.2, 0.4, 0.6] }\n";
  const std::string colored = cube + "albedo = [0.9, 0.7, 0.5]\n";
  std::vector<std::string> options = layers({"denoising_albedo", "denoising_normal", "volumes"});
  options.emplace_back("render.passes=1");
  const Image alone = render(load(colored, options)).image;
  const double opacity = at(alone, "volume_volume0.A", 12, 8);
  EXPECT_GT(opacity, 0.99);
  EXPECT_NEAR(at(alone, "denoising_albedo.R", 12, 8), 0.9 * opacity, 1e-4);
  EXPECT_NEAR(at(alone, "denoising_albedo.B", 12, 8), 0.5 * opacity, 1e-4);
  EXPECT_NEAR(at(alone, "denoising_normal.Z", 12, 8), opacity, 1e-3);
  EXPECT_EQ(at(alone, "denoising_albedo.G", 0, 0), 0);
  EXPECT_EQ(at(alone, "denoising_normal.Z", 0, 0), 0);
  options.emplace_back("volume.0.extinction=0.3");
  const Image both = render(load(colored + wall, options)).image;
  const double seen = at(both, "volume_volume0.A", 12, 8);
  EXPECT_GT(seen, 0.1);
  EXPECT_LT(seen, 0.9);
  EXPECT_NEAR(at(both, "denoising_albedo.R", 12, 8), 0.9 * seen + 0.2 * (1 - seen), 1e-4);
  EXPECT_NEAR(at(both, "denoising_normal.X", 12, 8), 0.5 * (1 - seen), 2e-3);
  EXPECT_NEAR(at(both, "denoising_albedo.B", 0, 0), 0.6, 1e-6);
  EXPECT_NEAR(at(both, "denoising_normal.Z", 0, 0), std::sqrt(0.75), 1e-5);
}

TEST_F(RayLayersTest, ErrorIsTheRootOfTheVariance) {
  const Image image = render(load(cube, layers({"variance", "error"}))).image;
  double sum = 0;
  for (int x = 0; x < image.width; ++x) {
    const double error = at(image, "error.G", x, 8);
    EXPECT_NEAR(error * error, at(image, "variance.G", x, 8), 1e-6 * error * error);
    sum += error;
  }
  EXPECT_GT(sum, 0);
}

TEST_F(RayLayersTest, HoldoutAndShadow) {
  const std::string meshes =
      "[[mesh]]\ntype = \"sphere\"\nscale = 0.4\ntranslate = [-2, 0, -3]\nmaterial = \"holdout\"\n"
      "[[mesh]]\ntype = \"quad\"\nscale = 9\ntranslate = [0, 0, -4]\n"
      "material = \"shadow_catcher\"\n"
      "[[light]]\ntype = \"distant\"\ndirection = [0.2, 0, -1]\nirradiance = 9\n";
  const Image image =
      render(load(cube + meshes,
                  layers({"holdout", "shadow", "depth", "alpha", "position", "samples"})))
          .image;
  EXPECT_NEAR(at(image, "holdout.Y", 4, 8), 1, 1e-6);
  EXPECT_EQ(at(image, "holdout.Y", 12, 8), 0);
  // Where the cube's shadow falls beside it, alpha is the shadow, as far away as the catcher.
  EXPECT_GT(at(image, "A", 18, 8), 0.2);
  EXPECT_NEAR(at(image, "shadow.G", 18, 8), 1 - at(image, "A", 18, 8), 1e-6);
  EXPECT_NEAR(at(image, "shadow.R", 4, 8), 1, 1e-6);
  EXPECT_NEAR(at(image, "depth.Z", 18, 8), 14, 1e-3);
  EXPECT_NEAR(at(image, "position.Z", 18, 8), -4, 1e-3);
  EXPECT_EQ(at(image, "samples.Y", 3, 3), 4);
}

/// The matte, and all that is no light, belong to the scene and not to a group of its lights; the
/// groups' light adds up to the beauty.
TEST_P(LayersOfVolumes, GroupsOfLightsDoNotChangeTheMatte) {
  const std::string scene =
      cube +
      "[[mesh]]\ntype = \"sphere\"\nscale = 0.4\ntranslate = [-2, 0, -3]\nmaterial = \"holdout\"\n"
      "[[mesh]]\ntype = \"quad\"\nscale = 9\ntranslate = [0, 0, -4]\n"
      "material = \"shadow_catcher\"\n"
      "[[light]]\ntype = \"distant\"\ndirection = [0.2, 0, -1]\nirradiance = 9\n";
  std::vector<std::string> options = layers({"holdout", "shadow", "depth", "alpha", "samples"});
  options.push_back(std::string("render.estimator=") + GetParam());
  options.emplace_back("image.cryptomatte=true");
  const Image plain = render(load(scene, options)).image;
  options.emplace_back("light.0.group=fill");
  options.emplace_back("light.1.group=key");
  const Image grouped = render(load(scene, options)).image;
  double shadow = 0;
  for (const ImageChannel& channel : plain.channels) {
    const bool is_light = channel.name.size() == 1
                              ? channel.name != "A"
                              : channel.name.ends_with(".R") || channel.name.ends_with(".G") ||
                                    channel.name.ends_with(".B");
    if (is_light && !channel.name.starts_with("crypto") && !channel.name.starts_with("shadow."))
      continue;
    EXPECT_EQ(plane(grouped, channel.name), channel.data) << channel.name;
    if (channel.name == "shadow.G")
      shadow = 1 - *std::min_element(channel.data.begin(), channel.data.end());
  }
  EXPECT_GT(shadow, 0.2);
}

const std::vector<std::string> everything{"depth_near", "depth_far",        "position",
                                          "motion",     "density_gradient", "volumes",
                                          "samples",    "denoising_albedo", "denoising_normal"};

TEST_F(RayLayersTest, PartsMergeExactly) {
  const Scene scene = load(two_volumes, layers(everything));
  const Image whole = render(scene).image;
  const auto parts = test::render_parts(scene, folder_, {{0, 0}, {1, 3}});
  const Image merged = merge_partials(parts);
  ASSERT_EQ(merged.channels.size(), whole.channels.size());
  for (std::size_t c = 0; c < whole.channels.size(); ++c) {
    EXPECT_EQ(merged.channels[c].name, whole.channels[c].name);
    EXPECT_EQ(merged.channels[c].data, whole.channels[c].data) << whole.channels[c].name;
  }
  test::render_parts(load(two_volumes, layers({"volumes"})), folder_, {{1, 3}});
  EXPECT_THROW(merge_partials(parts), InputError); // which holds fewer planes
}

TEST_F(RayLayersTest, CheckpointsAndCropsKeepThem) {
  const Scene scene = load(two_volumes, layers(everything));
  const Image whole = render(scene).image;
  FrameSettings frame;
  frame.checkpoint.path = folder_.file("c.exr");
  frame.checkpoint.passes = 2;
  render(load(two_volumes,
              [&] {
                std::vector<std::string> more = layers(everything);
                more.emplace_back("render.passes=2");
                return more;
              }()),
         frame);
  frame.checkpoint.resume = true;
  const RenderResult resumed = render(scene, frame);
  EXPECT_EQ(resumed.resumed_passes, 2);
  FrameSettings crop;
  crop.region = PixelRegion{8, 4, 18, 12};
  const Image part = render(scene, crop).image;
  for (const ImageChannel& channel : whole.channels) {
    EXPECT_EQ(plane(resumed.image, channel.name), channel.data) << channel.name;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 10; ++x)
        ASSERT_EQ(at(part, channel.name, x, y), at(whole, channel.name, 8 + x, 4 + y))
            << channel.name;
  }
}

TEST_F(RayLayersTest, NamesTheMistake) {
  const auto error_of = [&](const std::string& text, const std::vector<std::string>& more) {
    try {
      load(text, more);
    } catch (const InputError& error) {
      const std::string line = error.what();
      return line.substr(line.find(": ") + 2);
    }
    return std::string();
  };
  EXPECT_EQ(error_of(cube, {"layer.0.name=volumes", "volume.0.name=direct"}),
            "volume.0.name must be made of letters, digits, _ and -, and not be direct, indirect "
            "or emission, since its layer is asked for; got \"direct\"");
  EXPECT_EQ(error_of(cube, {"layer.0.name=volume_volume0", "render.clamp=1"}),
            "render.clamp excludes layers of volumes");
  EXPECT_EQ(error_of(cube, {"volume.0.name=direct"}), "");
}

} // namespace
} // namespace vdbeam
