#include "cli_fixture.h"

namespace vdbeam {
namespace {

using Messages = test::CliTest;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++n;
  return n;
}

TEST_F(Messages, FarmRefusesWhatRenderWouldRefuse) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"-o", "s.####.png"}, "-o " + file("s.####.png") + ": --skip-existing needs an .exr"},
      {{"-o", "s.####.exr", "--also=--missing=nothing"}, "--missing nothing: must be"},
      {{"-o", "s.####.exr", "--also=--region=9"}, "--region 9: must look like"},
      {{"-o", "s.####.exr", "--also=--prevew=a.png"}, "there is no option --prevew"},
      {{"-o", "s.####.exr", "--also=--preview=a.png"}, "frames would go to one file"},
      {{"-o", "s.####.exr", "--also=--set=camera.fov=0"}, "camera.fov must lie in (0, 180)"},
      {{"-o", "s.####.exr", "--passes", "4", "--splits", "2", "--also=--missing=black"},
       "--missing black: excludes --pass-range"}};
  for (const char* engine : {"slurm", "openjd"})
    for (const auto& [options, reason] : cases) {
      std::vector<std::string> words{"farm", engine, cloud, "-f", "1-2", "--job", "j.sh"};
      words.insert(words.end(), options.begin(), options.end());
      const auto result = run(words);
      EXPECT_EQ(result.code, 2) << result.error;
      EXPECT_TRUE(result.error.starts_with("the tasks of this job would fail: ")) << result.error;
      EXPECT_NE(result.error.find(reason), std::string::npos) << result.error;
      EXPECT_FALSE(exists("j.sh"));
    }
}

TEST_F(Messages, CountsAreInTheRightNumber) {
  const auto one = run({"farm", "slurm", smoke_pattern, "-f", "1", "-o", "s.exr", "--passes", "4",
                        "--splits", "2", "--threads", "1", "--job", "j.sh"});
  EXPECT_EQ(one.code, 0) << one.error;
  EXPECT_NE(one.error.find("1 frame in 2 tasks and 1 merge, each of 1 thread and"),
            std::string::npos)
      << one.error;
}

TEST_F(Messages, InitSaysACommandThatWorks) {
  const std::string smoke = VDBEAM_SOURCE_DIR "/data/smoke/smoke.####.vdb";
  const auto result = run({"init", smoke, "-o", "shot.toml"});
  EXPECT_EQ(result.code, 0) << result.error;
  const std::string last = "render it with: vdbeam render shot.toml -f ";
  const std::size_t at = result.error.find(last);
  ASSERT_NE(at, std::string::npos) << result.error;
  std::string frames = result.error.substr(at + last.size());
  frames.pop_back();
  EXPECT_EQ(
      run({"farm", "slurm", "shot.toml", "-f", frames, "-o", "s.####.exr", "--job", "j.sh"}).code,
      0);
}

TEST_F(Messages, FramesOfAStillSceneAreNoted) {
  const std::string still = "nothing depends on the frame: all 2 images will be the same";
  const auto result = render({cloud, "-f", "1-2", "-o", "c.####.exr", "--passes", "1"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(count(result.error, still), 1u) << result.error;
  const std::string file = VDBEAM_SOURCE_DIR "/data/smoke/smoke.0012.vdb";
  const auto single = render({file, "-f", "1-2", "-o", "s.####.exr", "--passes", "1"});
  EXPECT_NE(single.error.find(still + "; volume.0.file names a single file of the sequence "),
            std::string::npos)
      << single.error;
  const auto moving = render({smoke_pattern, "-f", "1,12", "-o", "m.####.exr", "--passes", "1"});
  EXPECT_EQ(moving.code, 0) << moving.error;
  EXPECT_EQ(moving.error.find("depends on the frame"), std::string::npos) << moving.error;
}

TEST_F(Messages, NotesThatFramesShareAreToldOnceWithTheFrames) {
  const auto result = render({smoke_pattern, "-f", "1,12,24", "-o", "s.####.exr", "--passes", "1"});
  EXPECT_EQ(result.code, 0) << result.error;
  const std::string note = "Z is up";
  EXPECT_EQ(count(result.error, note), 2u) << result.error;
  EXPECT_NE(result.error.find("note, in frames 1,12,24: "), std::string::npos) << result.error;
}

TEST_F(Messages, PassesOfAFrameAreNoFinishedPictureByName) {
  const auto result = render({cloud, "--pass-range", "0-1"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(files(), std::vector<std::string>{"cloud.passes_0-1.exr"});
}

TEST_F(Messages, LastLineDescribesTheImage) {
  const auto result = render({cloud, "--passes", "1", "-o", "c.exr", "--report", "r.json"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_NE(result.error.find("; optical depth up to "), std::string::npos) << result.error;
  EXPECT_NE(result.error.find(" % black, "), std::string::npos) << result.error;
  EXPECT_NE(read("r.json").find("\"optical_depth\": "), std::string::npos);
}

TEST_F(Messages, ControlCharactersOfNamesDoNotReachTheTerminal) {
  const std::string name = "a\x1b[31m\r.vdb";
  std::filesystem::copy_file(fog_vdb, file(name));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", name}, {"plan", name}, {"render", name + "x"}}) {
    const auto result = run(words);
    EXPECT_EQ((result.out + result.error).find('\x1b'), std::string::npos) << result.out;
    EXPECT_EQ((result.out + result.error).find('\r'), std::string::npos) << result.out;
    EXPECT_NE((result.out + result.error).find("a\\x1b[31m"), std::string::npos) << result.out;
  }
}

TEST_F(Messages, FoldersThatCannotBeListedAreNoDefect) {
  std::filesystem::create_directory(folder_ / "locked");
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::none);
  const auto result = run({"info", "locked"});
  std::filesystem::permissions(folder_ / "locked", std::filesystem::perms::owner_all);
  EXPECT_EQ(result.code, 2);
  EXPECT_EQ(result.error, "locked: the folder cannot be read: Permission denied\n");
}

} // namespace
} // namespace vdbeam
