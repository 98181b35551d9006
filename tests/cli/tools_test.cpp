#include "cli_fixture.h"
#include "vdbeam/image_file.h"
#include "volume_factory.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace vdbeam {
namespace {

using Json = nlohmann::json;
using InfoCommand = test::CliTest;
using InitCommand = test::CliTest;
using PlanCommand = test::CliTest;
using CompareCommand = test::CliTest;

TEST_F(InfoCommand, ShowsGridsAndWhatWouldBeRendered) {
  const auto result = run({"info", cloud_vdb, VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb"});
  ASSERT_EQ(result.code, 0) << result.error;
  for (const char* text : {"2531378 active", "UniformScaleMap, voxel 0.012 x 0.012 x 0.012",
                           "grid \"density\", with extinction", "temperature", "vec3s",
                           "looks wrong   flame: is empty"})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
}

/// Every kind of volume is described, also those that cannot be rendered, with the same reason.
TEST_F(InfoCommand, AgreesWithRenderAboutEveryKindOfVolume) {
  int refused = 0;
  for (const VolumeKind& kind : volume_kinds()) {
    VolumeOptions options;
    options.size = 16;
    write_volume(kind.name, file("v.vdb"), options);
    const auto info = run({"info", "v.vdb"});
    const auto render_it = render({"v.vdb", "-o", "v.exr", "--passes", "1", "-q"});
    ASSERT_EQ(info.code, 0) << kind.name << info.error;
    const std::size_t nothing = info.out.find("rendered      nothing: ");
    EXPECT_EQ(nothing == std::string::npos, render_it.code == 0) << kind.name << "\n"
                                                                 << info.out << render_it.error;
    if (nothing == std::string::npos)
      continue;
    ++refused;
    // Behind the file's name both say the same.
    const std::string why = render_it.error.substr(std::string("v.vdb: ").size());
    EXPECT_NE(info.out.find(why), std::string::npos) << kind.name << "\n" << info.out << why;
  }
  EXPECT_GE(refused, 2); // a background, a frustum
}

TEST_F(InfoCommand, ReportsMeshes) {
  write("uv.obj", "v -1 0 0\nv 1 0 0\nv 1 3 0\nvt 0 0\nvt 2 0\nvt 2 1\nf 1/1 2/2 3/3\n");
  write("plain.obj", "v 9 0 0\nv 11 0 0\nv 11 3 4\nv 0 0 nan\nf 1 2 3\nf 1 2 4\n");
  const auto result = run({"info", "uv.obj", "plain.obj"});
  ASSERT_EQ(result.code, 0) << result.error;
  for (const char* text :
       {"uv.obj\n  triangles     1\n", "bounds        (-1, 0, 0) to (1, 3, 0)",
        "size          (2, 3, 0)", "UV            yes: u from 0 to 2, v from 0 to 1\n",
        "bounds        (9, 0, 0) to (11, 3, 4)", "UV            none: textures cannot be used",
        "looks wrong   plain.obj: "})
    EXPECT_NE(result.out.find(text), std::string::npos) << text << "\n" << result.out;
}

TEST_F(InfoCommand, ReportsImages) {
  Image image;
  image.width = 2;
  image.height = 1;
  image.primaries = chromaticities_of(ColorSpace::acescg);
  image.channels = {{"R", {0.25f, 4}}, {"G", {-1, 0.5f}}, {"B", {HUGE_VALF, 1}}, {"Z", {1, 2}}};
  for (ImageChannel& channel : image.channels)
    channel.half = false;
  write_exr(image, file("a.exr"));
  const auto exr = run({"info", "a.exr"});
  ASSERT_EQ(exr.code, 0) << exr.error;
  for (const char* text :
       {"size          2 x 1 pixels", "channels      B, G, R, Z\n",
        "linear, with the primaries of ACEScg", "R             0.25 to 4, mean 2.125",
        "G             -1 to 0.5, mean -0.25", "B             1 to 1, mean 1",
        "as albedo     1 value above 1, clamped to 1", "looks wrong   1 value below 0",
        "looks wrong   1 value: infinite"})
    EXPECT_NE(exr.out.find(text), std::string::npos) << text << "\n" << exr.out;
  write_png(image, file("a.png"), 0, "srgb");
  const auto png = run({"info", "a.png"});
  EXPECT_NE(png.out.find("sRGB, made linear"), std::string::npos) << png.out << png.error;
  write("bad.png", "no picture");
  EXPECT_EQ(run({"info", "bad.png"}).code, 2);
}

TEST_F(InfoCommand, OneBadFileDoesNotHideTheOthers) {
  write("bad.vdb", "no");
  const auto result = run({"info", "bad.vdb", "none.vdb", cloud_vdb});
  EXPECT_NE(result.code, 0);
  EXPECT_EQ(result.error_lines(), 2u) << result.error;
  EXPECT_NE(result.out.find("2531378 active"), std::string::npos);
}

TEST_F(InfoCommand, TakesPatternsAndFolders) {
  const auto pattern = run({"info", smoke_pattern});
  ASSERT_EQ(pattern.code, 0) << pattern.error;
  EXPECT_TRUE(pattern.out.starts_with(smoke_pattern + ": frames 1,12,24; shown are 1,12,24\n"))
      << pattern.out;
  const auto folder = run({"info", VDBEAM_SOURCE_DIR "/data/smoke"});
  EXPECT_EQ(folder.code, 0) << folder.error;
  EXPECT_EQ(folder.out, pattern.out.substr(pattern.out.find('\n') + 1));
  std::filesystem::create_directory(folder_ / "none");
  EXPECT_EQ(run({"info", "none"}).error, "none: is a folder without a .vdb file\n");
  EXPECT_NE(run({"info", "x.####.vdb"}).error.find("there is no file"), std::string::npos);
}

TEST_F(InitCommand, WritesASceneThatLoads) {
  const auto result = run({"init", cloud_vdb, "-o", "s.toml"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(run({"plan", "s.toml"}).code, 0);
  EXPECT_NE(run({"init", cloud_vdb}).out.find("[[volume]]"), std::string::npos);
}

TEST_F(InitCommand, ReplacesOnlyWhenForced) {
  write("s.toml", "mine");
  const auto refused = run({"init", cloud_vdb, "-o", "s.toml"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_EQ(refused.error, "-o s.toml: exists; --force replaces it\n");
  EXPECT_EQ(read("s.toml"), "mine");
  EXPECT_EQ(run({"init", cloud_vdb, "-o", "s.toml", "--force"}).code, 0);
  EXPECT_NE(read("s.toml"), "mine");
}

TEST_F(PlanCommand, PrintsStagesAndReasons) {
  const auto result = run({"plan", cloud, "--estimator", "path"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.out.find("the path estimator traces no photons"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("left out"), std::string::npos);
}

TEST_F(PlanCommand, Json) {
  const auto result = run({"plan", smoke_pattern, "--json", "-f", "24"});
  ASSERT_EQ(result.code, 0) << result.error;
  const Json plan = Json::parse(result.out);
  EXPECT_EQ(plan["frame"], 24);
  EXPECT_GT(plan["memory"]["parts"]["film"]["rendering"], 0);
  EXPECT_FALSE(plan["stages"].empty());
  EXPECT_TRUE(plan["stages"][0]["reason"].is_string());
}

TEST_F(CompareCommand, SequencesHaveATemporalError) {
  for (const char* seed : {"1", "2"})
    ASSERT_EQ(run({"render", cloud, "-f", "1-3", "-o", std::string("s") + seed + ".####.exr",
                   "--seed", seed, "--set", "render.seeds=per_frame", "--passes", "2",
                   "--resolution", "32x18", "--set", "render.photons=2000", "-q"})
                  .code,
              0);
  const auto result = run({"compare", "s1.####.exr", "s2.####.exr", "-f", "1-3", "--json"});
  ASSERT_EQ(result.code, 0) << result.error;
  const Json json = Json::parse(result.out);
  ASSERT_EQ(json["frames"].size(), 3u);
  EXPECT_FALSE(json["frames"][0].contains("temporal"));
  const double second = json["frames"][1]["temporal"], third = json["frames"][2]["temporal"];
  EXPECT_GT(second, 0);
  EXPECT_DOUBLE_EQ(json["temporal"], (second + third) / 2);
  double mrse = 0;
  for (const Json& frame : json["frames"])
    mrse += frame["mrse"].get<double>() / 3;
  EXPECT_DOUBLE_EQ(json["mrse"], mrse);
  EXPECT_NE(run({"compare", "s1.####.exr", "s2.####.exr", "-f", "1-3"}).out.find("temporal error"),
            std::string::npos);
}

TEST_F(CompareCommand, SequencesThatAreNoneAreBadInput) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"a.exr", "b.####.exr", "-f", "1-3"},
        {"a.####.exr", "b.####.exr", "-f", "1"},
        {"a.####.exr", "b.####.exr", "-f", "1..3"},
        {"a.####.exr", "b.####.exr", "-f", "1-3"}}) {
    std::vector<std::string> arguments{"compare"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << result.error;
  }
}

TEST_F(CompareCommand, UnreadableImagesAreBadInput) {
  write("text.exr", "hello");
  for (const char* name : {"none.exr", "text.exr", "text.txt"}) {
    const auto result = run({"compare", name, name});
    EXPECT_EQ(result.code, 2) << result.error;
    EXPECT_EQ(result.error_lines(), 1u) << result.error;
  }
}

} // namespace
} // namespace vdbeam
