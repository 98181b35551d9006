// A frame with all that a shot may ask for (motion blur of everything, deep samples, layers in
// parts of their own, groups of lights, Cryptomatte, overscan) rendered in pieces, as farms do: its
// files hold what those of an undivided render hold, bit for bit.
#include "cli_fixture.h"
#include "support/read_deep.h"
#include "vdbeam/image_file.h"
#include "volume_factory.h"

#include <ImfMultiPartInputFile.h>

#include <cstring>

namespace vdbeam {
namespace {

using Names = std::vector<std::string>;
namespace fs = std::filesystem;

const char* shot = R"([image]
width = 24
height = 16
overscan = 2
deep = true
cryptomatte = true
parts = "layers"
fps = 24
[camera]
position = { keys = [[1, [0, 0, 6]], [2, [0.5, 0, 6]]] }
look_at = [0, 0, 0]
shutter_open = -0.25
shutter_close = 0.25
shutter_times = 4
lens_radius = 0.05
[[volume]]
name = "ball"
file = "ball.vdb"
extinction = 3
albedo = 0.8
velocity_fps = 4
[[volume]]
name = "glow"
file = "cloud.vdb"
extinction = 5
translate = { keys = [[1, [-1, 0.3, -1]], [2, [-1, 0.6, -1]]] }
emission = { intensity = "density", color = [1, 0.4, 0.1] }
[[mesh]]
name = "rock"
type = "sphere"
scale = 0.4
translate = { keys = [[1, [1, -0.5, -1]], [2, [1.4, -0.5, -1]]] }
[[light]]
type = "distant"
direction = { keys = [[1, [-1, -1, -1]], [2, [-1, -1, 0]]] }
group = "sun"
[[light]]
type = "environment"
radiance = 0.2
[render]
photons = 1000
neighbours = 50
)";

class ShotJob : public test::CliTest {
protected:
  void SetUp() override {
    CliTest::SetUp();
    VolumeOptions options;
    options.size = 24;
    write_volume("staggered", file("ball.vdb"), options);
    write_volume("noise", file("cloud.vdb"), options);
    std::string layers;
    for (const char* name : {"alpha",
                             "volume",
                             "depth",
                             "lights",
                             "cryptomatte",
                             "background",
                             "transmittance",
                             "variance",
                             "samples",
                             "depth_near",
                             "depth_far",
                             "position",
                             "motion",
                             "density_gradient",
                             "denoising_albedo",
                             "denoising_normal",
                             "error",
                             "shadow",
                             "catcher_light",
                             "volumes"})
      layers += std::string("[[layer]]\nname = \"") + name + "\"\n";
    write("s.toml", shot + layers);
  }
  Names render_words(const char* output, int passes, const Names& more = {}) const {
    Names words{"render",
                "s.toml",
                "-q",
                "-o",
                output,
                "--passes",
                std::to_string(passes),
                "--set",
                std::string("render.estimator=") + estimator_};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void must_run(const Names& words) const {
    const auto result = run(words);
    ASSERT_EQ(result.code, 0) << result.error;
  }
  /// The parts of the flat file with their names and compressions, their channels bit for bit, what
  /// their headers say of the picture, and the deep file.
  void expect_same(const std::string& name, const std::string& other) const {
    SCOPED_TRACE(estimator_ + ": " + name + " and " + other);
    const std::string a = file(name + ".exr"), b = file(other + ".exr");
    expect_same_structure(a, b);
    const Image x = read_image(a), y = read_image(b);
    ASSERT_EQ(x.channels.size(), y.channels.size());
    EXPECT_GT(x.channels.size(), 30u);
    for (std::size_t c = 0; c < x.channels.size(); ++c) {
      EXPECT_EQ(x.channels[c].name, y.channels[c].name);
      EXPECT_EQ(x.channels[c].half, y.channels[c].half) << x.channels[c].name;
      ASSERT_EQ(x.channels[c].data.size(), y.channels[c].data.size());
      EXPECT_EQ(std::memcmp(x.channels[c].data.data(), y.channels[c].data.data(),
                            x.channels[c].data.size() * sizeof(float)),
                0)
          << x.channels[c].name;
    }
    EXPECT_EQ(attributes(x), attributes(y));
    const DeepImage d = test::read_deep(file(name + ".deep.exr")),
                    e = test::read_deep(file(other + ".deep.exr"));
    EXPECT_GT(d.z.size(), 100u);
    test::expect_same_deep(d, e);
  }
  static void expect_same_structure(const std::string& a, const std::string& b) {
    Imf::MultiPartInputFile x(a.c_str()), y(b.c_str());
    ASSERT_EQ(x.parts(), y.parts());
    EXPECT_GT(x.parts(), 10);
    for (int i = 0; i < x.parts(); ++i) {
      EXPECT_EQ(x.header(i).name(), y.header(i).name());
      EXPECT_EQ(x.header(i).compression(), y.header(i).compression());
      EXPECT_EQ(x.header(i).dataWindow(), y.header(i).dataWindow());
      EXPECT_EQ(x.header(i).displayWindow(), y.header(i).displayWindow());
    }
  }
  /// Names and values, of clocks and of the machine's state names alone, without those about
  /// the parts.
  static std::map<std::string, std::string> attributes(const Image& image) {
    std::map<std::string, std::string> all;
    for (const auto& [name, text] : image.metadata)
      all[name] = name == "capDate" ? "" : text;
    for (const auto& [name, number] : image.numbers)
      all[name] =
          name == "vdbeam:seconds" || name == "vdbeam:peakMemory" ? "" : std::to_string(number);
    for (const auto& [name, values] : image.matrices)
      for (const float value : values)
        all[name] += std::to_string(value) + " ";
    for (const char* of_parts : {"vdbeam:passHash", "vdbeam:passSet"})
      all.erase(of_parts);
    return all;
  }

  std::string estimator_ = "beam";
};

TEST_F(ShotJob, PartsMergeToTheWhole) {
  for (const char* estimator : {"beam", "path"}) {
    estimator_ = estimator;
    must_run(render_words("whole.exr", 6));
    must_run(render_words("a.exr", 6, {"--pass-range", "0-1"}));
    must_run(render_words("b.exr", 6, {"--pass-range", "2-5"}));
    must_run({"merge", "-q", "-o", "merged.exr", "--passes", "6", "b.exr", "a.exr"});
    expect_same("merged", "whole");
    must_run(render_words("joined.exr", 6, {"--from-parts", "a.exr", "--from-parts", "b.exr"}));
    expect_same("joined", "whole");
  }
}

TEST_F(ShotJob, PartsOfARegionMerge) {
  const Names region{"--region", "5,3,19,14"};
  must_run(render_words("whole.exr", 4, region));
  must_run(render_words("a.exr", 4, {"--pass-range", "0-2", region[0], region[1]}));
  must_run(render_words("b.exr", 4, {"--pass-range", "3-3", region[0], region[1]}));
  must_run(render_words("joined.exr", 4,
                        {"--from-parts", "a.exr", "--from-parts", "b.exr", region[0], region[1]}));
  expect_same("joined", "whole");
}

TEST_F(ShotJob, GoesOnFromItsCheckpoint) {
  for (const char* estimator : {"beam", "path"}) {
    estimator_ = estimator;
    const pid_t child = start(render_words("a.exr", 1'000'000, {"--checkpoint", "1"}));
    wait_until(child, [&] { return exists("a.checkpoint.exr"); });
    kill(child, SIGKILL);
    finish(child);
    const Image stopped = read_image(file("a.checkpoint.exr"));
    const int passes = static_cast<int>(stopped.numbers.at("vdbeam:passes")) + 2;
    const auto resumed = run({"render", "s.toml", "-o", "a.exr", "--passes", std::to_string(passes),
                              "--set", "render.estimator=" + estimator_});
    ASSERT_EQ(resumed.code, 0) << resumed.error;
    EXPECT_NE(resumed.error.find("resumes after"), std::string::npos) << resumed.error;
    must_run(render_words("whole.exr", passes));
    expect_same("a", "whole");
  }
}

/// A frame is finished where all of its files are.
TEST_F(ShotJob, AMissingDeepFileIsRenderedAgain) {
  must_run(render_words("a.exr", 2));
  const auto written = fs::last_write_time(folder_ / "a.exr");
  must_run(render_words("a.exr", 2, {"--skip-existing"}));
  EXPECT_EQ(fs::last_write_time(folder_ / "a.exr"), written);
  fs::remove(folder_ / "a.deep.exr");
  must_run(render_words("a.exr", 2, {"--skip-existing"}));
  EXPECT_TRUE(exists("a.deep.exr"));
  std::string deep = read("a.deep.exr");
  write("a.deep.exr", deep.substr(0, deep.size() / 2));
  must_run(render_words("a.exr", 2, {"--skip-existing"}));
  EXPECT_EQ(read("a.deep.exr").size(), deep.size());
}

} // namespace
} // namespace vdbeam
