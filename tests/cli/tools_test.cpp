#include "cli_fixture.h"

#include <nlohmann/json.hpp>

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

TEST_F(InfoCommand, OneBadFileDoesNotHideTheOthers) {
  write("bad.vdb", "no");
  const auto result = run({"info", "bad.vdb", "none.vdb", cloud_vdb});
  EXPECT_NE(result.code, 0);
  EXPECT_EQ(result.error_lines(), 2u) << result.error;
  EXPECT_NE(result.out.find("2531378 active"), std::string::npos);
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
  EXPECT_EQ(refused.error, "-o s.toml: is there already; --force replaces it\n");
  EXPECT_EQ(read("s.toml"), "mine");
  EXPECT_EQ(run({"init", cloud_vdb, "-o", "s.toml", "--force"}).code, 0);
  EXPECT_NE(read("s.toml"), "mine");
}

TEST_F(PlanCommand, TellsStagesAndReasons) {
  const auto result = run({"plan", cloud, "--estimator", "path"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.out.find("the path estimator shoots none"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("left out"), std::string::npos);
}

TEST_F(PlanCommand, Json) {
  const auto result = run({"plan", smoke_pattern, "--json", "-f", "24"});
  ASSERT_EQ(result.code, 0) << result.error;
  const Json plan = Json::parse(result.out);
  EXPECT_EQ(plan["frame"], 24);
  EXPECT_GT(plan["memory"]["film"], 0);
  EXPECT_FALSE(plan["stages"].empty());
  EXPECT_TRUE(plan["stages"][0]["reason"].is_string());
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
