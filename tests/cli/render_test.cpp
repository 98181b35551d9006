#include "cli_fixture.h"

#include "vdbeam/image_file.h"

#include <fcntl.h>
#include <nlohmann/json.hpp>

namespace vdbeam {
namespace {

using Json = nlohmann::json;
using RenderCommand = test::CliTest;

TEST_F(RenderCommand, WritesImagePreviewAndReport) {
  const auto result =
      render({cloud, "-o", "a.exr", "--preview", "a.png", "--report", "r.json", "--passes", "3"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_TRUE(result.out.empty());
  EXPECT_EQ(files(), (std::vector<std::string>{"a.exr", "a.png", "r.json"}));
  const Image image = read_image(file("a.exr"));
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 18);
  for (const char* channel : {"R", "G", "B", "A", "depth.Z"})
    EXPECT_NE(image.find(channel), nullptr) << channel;

  const Json report = Json::parse(read("r.json"));
  EXPECT_EQ(report["passes"].size(), 3u);
  EXPECT_EQ(report["passes"][2]["pass"], 3);
  EXPECT_FALSE(report["passes"][2].contains("mrse"));
  EXPECT_EQ(report["stopped_by"], "passes");
  EXPECT_EQ(report["settings"]["render"]["passes"], 3);
  EXPECT_EQ(report["settings"]["volume"][0]["phase"]["g"], 0.6);
  EXPECT_EQ(report["settings"]["volume"][0]["albedo"][0], 0.99);
  EXPECT_EQ(report["scene_hash"].get<std::string>().size(), 16u);
  EXPECT_GT(report["peak_memory"], 1000000);
  EXPECT_GT(report["counts"]["camera_rays"], 0);
  EXPECT_FALSE(report["plan"]["stages"].empty());
  for (const char* stage : {"read", "build", "trace", "order", "radii", "query", "direct", "write"})
    EXPECT_TRUE(report["seconds"].contains(stage)) << stage;
  EXPECT_TRUE(report["machine"].contains("cpu"));
  EXPECT_TRUE(report["versions"].contains("OpenVDB"));
}

TEST_F(RenderCommand, ImageStoresItsCameraAndScene) {
  ASSERT_EQ(render({cloud, "-o", "a.exr", "--passes", "1", "--estimator", "path"}).code, 0);
  const std::string bytes = read("a.exr");
  for (const char* name :
       {"worldToCamera", "worldToNDC", "vdbeam:sceneHash", "vdbeam:passes", "software"})
    EXPECT_NE(bytes.find(name), std::string::npos) << name;
}

TEST_F(RenderCommand, ReferenceGivesErrorsOfEveryPass) {
  ASSERT_EQ(render({cloud, "-o", "ref.exr", "--passes", "8", "--estimator", "path"}).code, 0);
  const auto result = render({cloud, "-o", "a.exr", "--passes", "2", "--estimator", "path",
                              "--seed", "2", "--reference", "ref.exr", "--report", "r.json"});
  ASSERT_EQ(result.code, 0) << result.error;
  const Json report = Json::parse(read("r.json"));
  for (const Json& pass : report["passes"])
    for (const char* metric : {"rmse", "mrse", "relmse", "bias"})
      EXPECT_TRUE(pass[metric].is_number()) << metric;
  EXPECT_TRUE(report["passes"][0]["error_estimate"].is_null()); // one pass has no spread

  const auto compare = run({"compare", "a.exr", "ref.exr", "--json"});
  ASSERT_EQ(compare.code, 0) << compare.error;
  const Json metrics = Json::parse(compare.out);
  // The file holds halves, the report's image floats.
  EXPECT_NEAR(metrics["mrse"].get<double>() / report["passes"][1]["mrse"].get<double>(), 1, 0.01);
  EXPECT_GT(metrics["flip"], 0);
  EXPECT_NE(run({"compare", "a.exr", "ref.exr"}).out.find("relMSE"), std::string::npos);
}

TEST_F(RenderCommand, TwoReferencesGiveErrorsFreeOfTheirNoise) {
  const auto path = [&](const char* name, const char* passes, const char* seed) {
    return std::vector<std::string>{cloud,    "-o", name,          "--passes", passes,
                                    "--seed", seed, "--estimator", "path"};
  };
  ASSERT_EQ(render(path("a.exr", "2", "11")).code, 0);
  ASSERT_EQ(render(path("b.exr", "2", "12")).code, 0);
  std::vector<std::string> arguments = path("v.exr", "64", "13");
  arguments.insert(arguments.end(), {"--second-reference", "b.exr", "--report", "r.json"});
  EXPECT_EQ(render(arguments).error, "--second-reference: belongs to --reference; give both\n");
  arguments.insert(arguments.end(), {"--reference", "a.exr"});
  ASSERT_EQ(render(arguments).code, 0);
  const Json report = Json::parse(read("r.json"));
  EXPECT_EQ(report["second_reference"], "b.exr");
  const double reported = report["passes"].back()["mrse"].get<double>();
  const Json two =
                 Json::parse(run({"compare", "v.exr", "a.exr", "--second", "b.exr", "--json"}).out),
             one = Json::parse(run({"compare", "v.exr", "a.exr", "--json"}).out);
  EXPECT_NEAR(reported, two["mrse"].get<double>(), 0.01 * one["mrse"].get<double>());
  // The picture has 64 passes, the references 2 each: alone they would count 33 times as much.
  EXPECT_LT(std::abs(reported), 0.5 * one["mrse"].get<double>());
}

TEST_F(RenderCommand, WrongReferenceSizeIsRefusedBeforeRendering) {
  ASSERT_EQ(render({cloud, "-o", "ref.exr", "--passes", "1"}).code, 0);
  const auto result =
      run({"render", cloud, "--resolution", "16x16", "--reference", "ref.exr", "-o", "a.exr"});
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error, "--reference ref.exr: is 32x18, but the image is 16x16; use --resolution "
                          "32x18\n");
  EXPECT_FALSE(exists("a.exr"));
}

TEST_F(RenderCommand, BareVdbAndDefaultName) {
  const auto result = render({fog_vdb, "--passes", "1"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_TRUE(exists("fog.exr"));
  EXPECT_NE(result.error.find("extinction"), std::string::npos); // what was chosen is said
}

TEST_F(RenderCommand, SequenceOfABareVdb) {
  const auto none = render({smoke_pattern});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.error.find("give a range of frames, e.g. -f 1,12,24"), std::string::npos)
      << none.error;
  const auto result = render({smoke_pattern, "-f", "1,24", "--passes", "1"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(files(), (std::vector<std::string>{"smoke.0001.exr", "smoke.0024.exr"}));
  EXPECT_NE(result.error.find("frame 24 (2/2)"), std::string::npos);
}

TEST_F(RenderCommand, FramesThatAreAllMissingAreToldAtOnce) {
  const auto result = render({smoke_pattern, "-f", "2-3", "--passes", "1"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.error.find("there are frames 1"), std::string::npos) << result.error;
  EXPECT_TRUE(files().empty());
}

TEST_F(RenderCommand, OneBadFrameDoesNotStopTheOthers) {
  for (const char* name : {"c.0001.vdb", "c.0003.vdb"})
    std::filesystem::copy_file(fog_vdb, folder_ / name);
  write("c.0002.vdb", "not a volume");
  write("s.toml", "[[volume]]\nfile = 'c.####.vdb'\n[[light]]\ntype = 'environment'\n");
  const auto result = render({"s.toml", "-f", "1-3", "--passes", "1"});
  EXPECT_EQ(result.code, 3);
  EXPECT_TRUE(exists("s.0001.exr"));
  EXPECT_FALSE(exists("s.0002.exr"));
  EXPECT_TRUE(exists("s.0003.exr"));
}

TEST_F(RenderCommand, FailureLeavesNoFileAndSaysOneLine) {
  write("bad.vdb", "not a volume");
  write("s.toml", "[[volume]]\nfile = 'bad.vdb'\n");
  const auto result = render({"s.toml", "-q", "-o", "a.exr", "--report", "r.json"});
  EXPECT_GE(result.code, 2);
  EXPECT_LE(result.code, 3);
  EXPECT_EQ(result.error_lines(), 1u) << result.error;
  EXPECT_EQ(files(), (std::vector<std::string>{"bad.vdb", "s.toml"}));
}

TEST_F(RenderCommand, QuietSaysNothing) {
  const auto result = render({cloud, "-q", "-o", "a.exr", "--passes", "1"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.error.empty()) << result.error;
}

TEST_F(RenderCommand, StopRuleOfTheCommandLineReplacesTheFilesRule) {
  write("s.toml", "[render]\npasses = 1\n");
  const auto result = render({"s.toml", "--time", "0.2", "-o", "a.exr", "--report", "r.json"});
  ASSERT_EQ(result.code, 0) << result.error;
  const Json report = Json::parse(read("r.json"));
  EXPECT_EQ(report["stopped_by"], "time");
}

/// A pass of this picture takes a minute or more. Processor time is bounded: a busy machine may let
/// the program wait.
TEST_F(RenderCommand, TimeLimitHoldsInsideTheFirstPass) {
  const std::vector<std::string> arguments{
      "render",    cloud,   "--estimator", "beam",   "--resolution", "960x2160",
      "--threads", "2",     "--time",      "6s",     "-o",           "a.exr",
      "--preview", "a.png", "--report",    "r.json", "--set",        "render.photons=20000000"};
  const auto result = run(arguments);
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.error.find("the image is a draft"), std::string::npos) << result.error;
  EXPECT_LT(result.processor_seconds, 20);
  EXPECT_TRUE(exists("a.png"));
  const Image image = read_image(file("a.exr"));
  EXPECT_EQ(image.height, 2160);
  EXPECT_EQ(image.numbers.at("vdbeam:passes"), 0);
  EXPECT_EQ(image.numbers.count("vdbeam:complete"), 0u);
  float brightest = 0;
  for (const float value : image.find("volume.R")->data)
    brightest = std::max(brightest, value);
  EXPECT_GT(brightest, 0.01f);
  const Json report = Json::parse(read("r.json"));
  EXPECT_EQ(report["stopped_by"], "time");
  EXPECT_EQ(report["quick_look"], false);
  EXPECT_GT(report["draft"], 1);
  EXPECT_EQ(image.numbers.at("vdbeam:draft"), report["draft"]);
  EXPECT_TRUE(report["passes"].empty());
}

TEST_F(RenderCommand, QuickLookIsNoFinishedFrame) {
  // The volume is read within half a second, also in an instrumented program.
  const std::string fog = VDBEAM_SOURCE_DIR "/data/fog.vdb";
  EXPECT_EQ(render({fog, "--time", "0.000001", "-o", "a.exr"}).code, 3);
  ASSERT_TRUE(exists("a.exr"));
  const auto result = render({fog, "--passes", "1", "-o", "a.exr", "--skip-existing"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.error.find("is not marked as finished"), std::string::npos) << result.error;
  EXPECT_EQ(read_image(file("a.exr")).numbers.at("vdbeam:complete"), 1);
}

TEST_F(RenderCommand, CheckpointOfMorePassesSaysSo) {
  const pid_t child = start({"render", cloud, "--time", "1h", "--resolution", "32x18", "--set",
                             "render.photons=2000", "-o", "a.exr", "--checkpoint", "3"});
  wait_until(child, [&] { return exists("a.checkpoint.exr"); });
  kill(child, SIGTERM);
  finish(child);
  const auto result = render({cloud, "--passes", "1", "-o", "a.exr"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.error.find(" passes, more than the 1 asked for; the frame starts over"),
            std::string::npos)
      << result.error;
}

TEST_F(RenderCommand, NegativeFramesAndExposures) {
  const auto result = render({cloud, "-f", "-2--1", "-o", "a.%d.exr", "--preview", "a.%d.png",
                              "--exposure", "-1", "--passes", "1"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(files(), (std::vector<std::string>{"a.-1.exr", "a.-1.png", "a.-2.exr", "a.-2.png"}));
}

class Interrupt : public test::CliTest, public ::testing::WithParamInterface<int> {};

/// A render that would take an hour ends soon after the signal; the passes so far are in a
/// checkpoint that opens as an image, and nothing bears the image's name.
TEST_P(Interrupt, WritesTheImageSoFar) {
  const pid_t child =
      start({"render", cloud, "--time", "1h", "--resolution", "32x18", "--set",
             "render.photons=2000", "-o", "a.exr", "--report", "r.json", "--preview", "a.png"});
  wait_for_output(child);
  // Signals before the end of the first pass would leave nothing to write.
  kill(child, SIGUSR1);
  wait_until(child, [&] { return exists("a.snapshot.exr"); });
  kill(child, GetParam());
  const auto result = finish(child);
  EXPECT_EQ(result.code, 128 + GetParam()) << result.error;
  EXPECT_FALSE(exists("a.exr"));
  EXPECT_EQ(read_image(file("a.checkpoint.exr")).width, 32);
  const Json report = Json::parse(read("r.json"));
  EXPECT_EQ(report["stopped_by"], "stop");
  ASSERT_GE(report["passes"].size(), 1u);
  EXPECT_NE(result.error.find("interrupted"), std::string::npos);
  // The preview shows them as well, no longer the quick look.
  const std::string passes = report["passes"].back()["pass"].dump();
  const auto again = run({"render", cloud, "--resolution", "32x18", "--set", "render.photons=2000",
                          "--passes", passes, "-o", "b.exr", "--preview", "b.png"});
  ASSERT_EQ(again.code, 0) << again.error;
  EXPECT_EQ(read("a.png"), read("b.png"));
}

/// One pass of these takes hours: it is abandoned. Processor time is compared, not the clock, which
/// runs on while a busy machine does something else.
TEST_P(Interrupt, EndsWithinSecondsInsideAPass) {
  using Words = std::vector<std::string>;
  const Words endless_paths{"--estimator",      "path", "--set", "volume.0.extinction=1e6", "--set",
                            "volume.0.albedo=1"};
  const Words endless_photons{"--set", "render.photons=100000000",
                              "--set", "volume.0.extinction=1e5",
                              "--set", "volume.0.albedo=1"};
  for (const Words& options : {endless_paths, endless_photons}) {
    Words arguments{"render", cloud, "--passes", "1", "-o", "a.exr"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    std::filesystem::remove(folder_ / "stderr.txt"); // the last one's words
    const pid_t child = start(arguments);
    wait_for_output(child);
    const double begin = processor_seconds(child);
    kill(child, GetParam());
    const auto result = finish(child);
    EXPECT_LT(result.processor_seconds - begin, 5);
    EXPECT_FALSE(result.killed);
    EXPECT_EQ(result.code, 128 + GetParam()) << result.error;
    // A rough picture for the eye: no image by the frame's name, and nothing to resume from.
    EXPECT_EQ(files(), (Words{"a.snapshot.exr"}));
    const Image look = read_image(file("a.snapshot.exr"));
    EXPECT_EQ(look.width, 320);
    EXPECT_EQ(look.numbers.at("vdbeam:passes"), 0);
    EXPECT_EQ(look.numbers.count("vdbeam:complete"), 0u);
    std::filesystem::remove(folder_ / "a.snapshot.exr");
  }
}

INSTANTIATE_TEST_SUITE_P(Signals, Interrupt, ::testing::Values(SIGINT, SIGTERM));

} // namespace
} // namespace vdbeam
