// Motion blur against brute force: the mean of images of 64 files, each with the volume
// moved by its velocity to a moment of the shutter's time by a tool that shares no code with the
// renderer.
#include "render/shutter.h"

#include "scene/shutter.h"
#include "support/statistics.h"
#include "support/temp_folder.h"
#include "vdbeam/scene_file.h"
#include "volume_factory.h"
#include "volume_mover.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace vdbeam {
namespace {

constexpr int moments = 64, replicates = 6, pixels = 24, regions = 4; ///< regions per axis
constexpr std::array<const char*, 2> channels{"R", "A"};

/// Means over the regions of a picture, with one picture per replicate as a sample.
using RegionSamples = std::array<test::Samples, regions * regions>;
using RegionMeans = std::array<double, regions * regions>;

void add_regions(const Image& image, const char* channel, double weight, RegionMeans& means) {
  constexpr int width = pixels / regions;
  const std::vector<float>& values = image.find(channel)->data;
  for (int y = 0; y < pixels; ++y)
    for (int x = 0; x < pixels; ++x)
      means[static_cast<std::size_t>(y / width * regions + x / width)] +=
          weight * static_cast<double>(values[static_cast<std::size_t>(y * pixels + x)]) /
          (width * width);
}

class SubFrames : public testing::Test {
protected:
  SubFrames() {
    VolumeOptions options;
    options.size = 32;
    write_volume("whirl", folder_.file("cloud.vdb"), options);
  }
  Scene load(const std::string& file, const std::vector<std::string>& more = {}) {
    std::ofstream(folder_.file("s.toml"))
        << "[image]\nwidth = 24\nheight = 24\n[camera]\nposition = [0, 0, 6]\nfov = 15\n"
           "[[volume]]\nextinction = 12\nalbedo = 0.8\nvelocity_fps = 1\n"
           "[[light]]\ntype = \"distant\"\ndirection = [-1, -1, -1]\n"
           "[[light]]\ntype = \"environment\"\nradiance = 0.2\nvisible = false\n"
           "[render]\nphotons = 4000\nneighbours = 64\npasses = 64\n";
    std::vector<std::string> all{"render.estimator=" + estimator_,
                                 "volume.0.file=" + folder_.file(file)};
    all.insert(all.end(), more.begin(), more.end());
    return load_scene(folder_.file("s.toml"), 1, all);
  }
  Scene blurred(int seed) {
    return load("cloud.vdb",
                {"camera.shutter_close=0.5", "camera.shutter_times=" + std::to_string(moments),
                 "render.seed=" + std::to_string(seed)});
  }

  static std::string sub_frame(int part) { return "sub" + std::to_string(part) + ".vdb"; }
  void compare();

  test::TempFolder folder_;
  std::string estimator_;
};

void SubFrames::compare() {
  std::array<RegionSamples, channels.size()> by_renderer, by_tool;
  std::array<RegionMeans, channels.size()> unmoved{};
  std::array<std::vector<RegionMeans>, channels.size()> sums;
  sums.fill(std::vector<RegionMeans>(replicates));
  const Image still = render(load("cloud.vdb")).image;
  for (std::size_t c = 0; c < channels.size(); ++c)
    add_regions(still, channels[c], 1, unmoved[c]);
  for (int r = 0; r < replicates; ++r) {
    const Image image = render(blurred(1 + r)).image;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      RegionMeans means{};
      add_regions(image, channels[c], 1, means);
      for (std::size_t i = 0; i < means.size(); ++i)
        by_renderer[c][i].add(means[i]);
    }
  }
  // The passes at a moment are those that a blurred picture of other seeds would have there, so
  // that kernels are as wide.
  for (int part = 0; part < moments; ++part) {
    Scene scene = load(sub_frame(part), {"volume.0.velocity=none"});
    const PreparedScenePtr prepared = prepare_scene(scene);
    for (int r = 0; r < replicates; ++r) {
      scene.render.seed = static_cast<std::uint64_t>(1001 + r);
      int pass = 0;
      while (motion_sample(pass, moments, scene.render.seed) != static_cast<std::size_t>(part))
        ++pass;
      FrameSettings frame;
      frame.pass_range = PassRange{pass, pass};
      const Image image = render(scene, prepared, frame).image;
      for (std::size_t c = 0; c < channels.size(); ++c)
        add_regions(image, channels[c], 1.0 / moments, sums[c][static_cast<std::size_t>(r)]);
    }
  }
  for (std::size_t c = 0; c < channels.size(); ++c)
    for (const RegionMeans& means : sums[c])
      for (std::size_t i = 0; i < means.size(); ++i)
        by_tool[c][i].add(means[i]);
  // Each region's means agree by Student's t within the chance of 4 standard deviations, 6e-5; the
  // renderer ends its fixed point at a hundredth of a voxel, of the 8 that a region is wide.
  for (std::size_t c = 0; c < channels.size(); ++c) {
    int moved_regions = 0;
    for (std::size_t i = 0; i < by_tool[c].size(); ++i) {
      const test::Samples &a = by_renderer[c][i], &b = by_tool[c][i];
      SCOPED_TRACE(std::string(channels[c]) + " region " + std::to_string(i));
      test::expect_same_mean(a, b, 1e-3 * a.mean());
      if (a.mean() > 0.02)
        test::expect_power(a, 0.01 * a.mean());
      moved_regions += std::abs(unmoved[c][i] - a.mean()) > 0.05 * a.mean() + 1e-6;
    }
    EXPECT_GE(moved_regions, 8) << channels[c]; // a test that sees nothing move tests nothing
  }
}

TEST_F(SubFrames, SlowTheirMeanIsTheBlurredPicture) {
  MoveOptions options;
  options.fps = 1;
  const std::vector<double> times = middle_times(0, 0.5, moments);
  for (int part = 0; part < moments; ++part)
    move_volume(folder_.file("cloud.vdb"), folder_.file(sub_frame(part)),
                times[static_cast<std::size_t>(part)], options);
  for (const char* estimator : {"path", "beam"}) {
    SCOPED_TRACE(estimator);
    estimator_ = estimator;
    compare();
  }
}

} // namespace
} // namespace vdbeam
