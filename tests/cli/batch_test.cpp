#include "cli_fixture.h"
#include "vdbeam/image_file.h"

#include <cstring>
#include <nlohmann/json.hpp>

namespace vdbeam {
namespace {

using Json = nlohmann::json;
using Names = std::vector<std::string>;
using test::ProgramResult;

class BatchCommand : public test::CliTest {
protected:
  /// A scene of frames 1 to 3 and 5, all the same volume.
  void write_sequence() {
    for (const char* name : {"c.0001.vdb", "c.0002.vdb", "c.0003.vdb", "c.0005.vdb"})
      std::filesystem::copy_file(fog_vdb, folder_ / name);
    write("s.toml", "[[volume]]\nfile = 'c.####.vdb'\n[[light]]\ntype = 'environment'\n");
  }
  ProgramResult render_frames(const std::string& frames, const Names& more = {}) {
    Names arguments{"s.toml", "-f",         frames,      "--passes",    "1",
                    "-o",     "o.####.exr", "--summary", "summary.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return render(arguments);
  }
  /// "c.0007.vdb"
  static std::string fmt_name(const std::string& stem, int frame, const std::string& extension) {
    return stem + ".000" + std::to_string(frame) + "." + extension;
  }
  Json summary() const { return Json::parse(read("summary.json")); }
  std::vector<float> pixels(const std::string& name) const {
    return read_image(file(name)).find("R")->data;
  }
};

TEST_F(BatchCommand, SkipsFinishedFramesAndNoOthers) {
  write_sequence();
  ASSERT_EQ(render_frames("1-3").code, 0);
  const std::string second = read("o.0002.exr");
  write("o.0001.exr", read("o.0001.exr").substr(0, 4000)); // truncated
  write("o.0003.exr", read("o.0002.exr"));                 // another frame
  const auto again = render_frames("1-3,5", {"--skip-existing"});
  EXPECT_EQ(again.code, 0) << again.error;
  EXPECT_EQ(summary()["skipped"], Json::array({2}));
  EXPECT_EQ(summary()["done"], Json::array({1, 3, 5}));
  EXPECT_EQ(read("o.0002.exr"), second);
  EXPECT_EQ(read_image(file("o.0001.exr")).width, 32);
  // Another scene, and when asked to.
  render_frames("1-3", {"--skip-existing", "--seed", "9"});
  EXPECT_EQ(summary()["done"], Json::array({1, 2, 3}));
  render_frames("1-3", {"--skip-existing", "--seed", "9", "--overwrite"});
  EXPECT_EQ(summary()["done"], Json::array({1, 2, 3}));
  render_frames("1-3", {"--skip-existing", "--seed", "9"});
  EXPECT_EQ(summary()["skipped"], Json::array({1, 2, 3}));
}

/// Files that open as images of this very frame, and are not the finished one.
TEST_F(BatchCommand, PartialResizedAndCutImagesAreRenderedAgain) {
  write_sequence();
  ASSERT_EQ(render_frames("1").code, 0);
  const auto again = [&](const Names& made_by, const std::string& why) {
    std::filesystem::remove(folder_ / "o.0001.exr");
    Names words{"render", "s.toml", "-f", "1", "-o", "o.####.exr", "--set", "render.photons=2000"};
    words.insert(words.end(), made_by.begin(), made_by.end());
    ASSERT_EQ(run(words).code, 0);
    const auto result = render_frames("1", {"--skip-existing"});
    EXPECT_EQ(summary()["done"], Json::array({1})) << why;
    EXPECT_NE(result.error.find("rendered again: " + why), std::string::npos) << result.error;
  };
  again({"--pass-range", "0", "--resolution", "32x18"}, "is not marked as finished");
  again({"--passes", "1", "--resolution", "31x18"}, "has another size");
  again({"--passes", "1", "--resolution", "32x18", "--region", "1,1,20,18"}, "is of another scene");
  again({"--passes", "2", "--resolution", "32x18"}, "is of another scene");
  // A frame under another's name.
  ASSERT_EQ(render_frames("2").code, 0);
  write("o.0001.exr", read("o.0002.exr"));
  EXPECT_NE(render_frames("1", {"--skip-existing"}).error.find("is of another frame"),
            std::string::npos);
}

TEST_F(BatchCommand, ReportsFailuresAndGoesOn) {
  write_sequence();
  write("c.0002.vdb", "not a volume");
  const auto result = render_frames("1-5", {"--progress", "openjd"});
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(summary()["done"], Json::array({1, 3, 5}));
  EXPECT_EQ(summary()["failed"], Json::array({2, 4}));
  EXPECT_NE(summary()["frames"][3]["reason"].get<std::string>().find("there is no file"),
            std::string::npos);
  EXPECT_NE(result.error.find("5 frames: 3 done (1,3,5), 2 failed (2,4)"), std::string::npos)
      << result.error;
  EXPECT_NE(result.out.find("openjd_fail: "), std::string::npos);
  EXPECT_NE(result.out.find("openjd_progress: 100.0\n"), std::string::npos);
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.starts_with("openjd_")) << line;
}

/// Once, where it happens; the last line says which frames failed.
TEST_F(BatchCommand, ReportsAFailureOnce) {
  write_sequence();
  write("c.0002.vdb", "not a volume");
  const std::string text = render_frames("1-2").error, reason = "is not a VDB file";
  const std::size_t first = text.find(reason);
  ASSERT_NE(first, std::string::npos) << text;
  EXPECT_EQ(text.find(reason, first + 1), std::string::npos) << text;
}

TEST_F(BatchCommand, NamesTheLineOfTheSceneThatNamesABadFile) {
  write_sequence();
  const std::string head = "[[volume]]\nfile = 'c.####.vdb'\n",
                    light = "[[light]]\ntype = 'environment'\n";
  const auto error_of = [&](const std::string& key) {
    write("s.toml", head + key + "\n" + light);
    return render_frames("1").error;
  };
  EXPECT_NE(error_of("density = 'densty'").find("s.toml:3: volume.0.density: "), std::string::npos);
  EXPECT_NE(error_of("mask = 'density,matt'").find("s.toml:3: volume.0.mask: "), std::string::npos);
  EXPECT_NE(error_of("emission = { temperature = 'heat' }")
                .find("s.toml:3: volume.0.emission.temperature: "),
            std::string::npos);
  write("sky.exr", "no picture");
  write("s.toml", head + light + "image = 'sky.exr'\n");
  EXPECT_NE(render_frames("1").error.find("s.toml:5: light.0.image: "), std::string::npos);
  write("c.0001.vdb", "not a volume");
  EXPECT_NE(error_of("").find("s.toml:2: volume.0.file: "), std::string::npos);
}

TEST_F(BatchCommand, NotesACameraThatLooksPastTheVolume) {
  write_sequence();
  const Names away{"--set", "camera.position=[0,0,50]", "--set", "camera.look_at=[0,0,90]"};
  EXPECT_NE(render_frames("1", away).error.find("no volume is in view"), std::string::npos);
  EXPECT_EQ(render_frames("1").error.find("no volume is in view"), std::string::npos);
}

TEST_F(BatchCommand, ABareFileHasTheNumberInItsName) {
  for (const auto& [name, frame] : {std::pair("c.0020.vdb", 20), std::pair("c_0021.vdb", 21),
                                    std::pair("c_v22.vdb", 1), std::pair("c23.vdb", 1)}) {
    std::filesystem::copy_file(fog_vdb, folder_ / name);
    const auto result = render({name, "--passes", "1", "-o", "o.exr"});
    ASSERT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(read_image(file("o.exr")).numbers.at("vdbeam:frame"), frame) << name;
  }
}

TEST_F(BatchCommand, StopsAtTheFirstFailureWhenAsked) {
  write_sequence();
  write("c.0002.vdb", "not a volume");
  EXPECT_EQ(render_frames("1-3", {"--on-error", "stop"}).code, 3);
  EXPECT_TRUE(exists("o.0001.exr"));
  EXPECT_FALSE(exists("o.0003.exr"));
}

TEST_F(BatchCommand, MissingFramesAreHeldOrBlack) {
  write_sequence();
  ASSERT_EQ(render_frames("3-4", {"--missing", "hold"}).code, 0);
  EXPECT_NE(read("stderr.txt").find("frame 3 is shown"), std::string::npos);
  const std::vector<float> held = pixels("o.0004.exr");
  EXPECT_GT(*std::max_element(held.begin(), held.end()), 0.1f);
  ASSERT_EQ(render_frames("4-5", {"--missing", "black"}).code, 0);
  EXPECT_EQ(pixels("o.0004.exr"), std::vector<float>(32 * 18, 0.f));
  const auto again = render_frames("4-5", {"--missing", "black", "--skip-existing"});
  EXPECT_EQ(summary()["skipped"], Json::array({4, 5})) << again.error;
}

TEST_F(BatchCommand, AlfProgress) {
  write_sequence();
  const auto result = render_frames("1-2", {"--progress", "alf", "--threads", "1"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "ALF_PROGRESS 50%\nALF_PROGRESS 100%\n");
}

TEST_F(BatchCommand, PartialImagesMerge) {
  const Names scene{cloud, "--passes", "3", "-q"};
  const auto with = [&](Names more) {
    more.insert(more.begin(), scene.begin(), scene.end());
    return render(more).code;
  };
  ASSERT_EQ(with({"-o", "whole.exr"}), 0);
  ASSERT_EQ(with({"-o", "a.exr", "--pass-range", "0-1"}), 0);
  ASSERT_EQ(with({"-o", "b.exr", "--pass-range", "2"}), 0);
  EXPECT_EQ(run({"merge", "-o", "m.exr", "--passes", "3", "b.exr", "a.exr"}).code, 0);
  for (const char* channel : {"R", "A", "depth.Z"})
    EXPECT_EQ(read_image(file("m.exr")).find(channel)->data,
              read_image(file("whole.exr")).find(channel)->data);
  // The merged image is the finished one of this scene.
  ASSERT_EQ(with({"-o", "m.exr", "--skip-existing", "--summary", "summary.json"}), 0);
  EXPECT_EQ(summary()["skipped"], Json::array({1}));
  EXPECT_EQ(run({"merge", "-o", "n.exr", "b.exr"}).code, 2);
  EXPECT_FALSE(exists("n.exr"));
  ASSERT_EQ(
      with({"-o", "a.exr", "--pass-range", "0-1", "--skip-existing", "--summary", "summary.json"}),
      0);
  EXPECT_EQ(summary()["skipped"], Json::array({1}));
}

TEST_F(BatchCommand, MemoryIsThatOfTwoFrames) {
  for (int frame = 1; frame <= 7; ++frame)
    std::filesystem::copy_file(fog_vdb, folder_ / fmt_name("c", frame, "vdb"));
  write("s.toml", "[[volume]]\nfile = 'c.####.vdb'\n[[light]]\ntype = 'environment'\n");
  ASSERT_EQ(render({"s.toml", "-f", "1-7", "--passes", "1", "-q", "--report", "r.####.json"}).code,
            0);
  const auto peak = [&](int frame) {
    return Json::parse(read(fmt_name("r", frame, "json")))["peak_memory"].get<double>();
  };
  // Bricks of the cloud are 40 MB: two frames have them twice, seven would have 200 MB more.
  EXPECT_LT(peak(7), peak(3) + 40e6);
}

TEST_F(BatchCommand, BadValuesAreRefused) {
  for (const Names& option : std::vector<Names>{{"--pass-range", "3-1"},
                                                {"--pass-range", "a"},
                                                {"--region", "0,0,40,1"},
                                                {"--region", "1,2,3"},
                                                {"--checkpoint", "0"},
                                                {"--checkpoint", "soon"},
                                                {"--on-error", "panic"}}) {
    Names arguments{cloud, "-o", "a.exr", "--passes", "1"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    const auto result = render(arguments);
    EXPECT_EQ(result.code, 2) << option[0] << result.error;
    EXPECT_FALSE(exists("a.exr"));
  }
}

TEST_F(BatchCommand, ASignalLeavesACheckpointThatTheNextRunFinishes) {
  const auto command = [&](int passes, const char* output, const Names& more) {
    Names words{"render", cloud, "--set",    "render.photons=2000",  "--resolution", "32x18",
                "-f",     "1",   "--passes", std::to_string(passes), "-o",           output};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const pid_t child = start(command(1'000'000, "a.exr", {"--checkpoint", "1"}));
  wait_until(child, [&] { return exists("a.checkpoint.exr"); });
  kill(child, SIGTERM);
  const auto stopped = finish(child);
  ASSERT_EQ(stopped.code, 143) << stopped.error;
  EXPECT_EQ(files(), Names{"a.checkpoint.exr"});
  const std::size_t at = stopped.error.find("interrupted after ");
  ASSERT_NE(at, std::string::npos) << stopped.error;
  const int done = std::atoi(stopped.error.c_str() + at + std::strlen("interrupted after "));
  const auto resumed = run(command(done + 3, "a.exr", {}));
  EXPECT_EQ(resumed.code, 0);
  EXPECT_NE(resumed.error.find("resumes after"), std::string::npos) << resumed.error;
  EXPECT_EQ(files(), Names{"a.exr"});
  ASSERT_EQ(run(command(done + 3, "whole.exr", {})).code, 0);
  EXPECT_EQ(pixels("a.exr"), pixels("whole.exr"));
}

TEST_F(BatchCommand, SnapshotOnUserSignal) {
  const pid_t child = start({"render", cloud, "--time", "1h", "--resolution", "32x18", "--set",
                             "render.photons=2000", "-o", "a.exr"});
  wait_for_output(child);
  kill(child, SIGUSR1);
  wait_until(child, [&] { return exists("a.snapshot.exr"); });
  EXPECT_EQ(files(), Names{"a.snapshot.exr"});
  EXPECT_EQ(read_image(file("a.snapshot.exr")).width, 32);
  kill(child, SIGTERM);
  EXPECT_EQ(finish(child).code, 143);
}

TEST_F(BatchCommand, AFinishedFrameLeavesNothingBesideIt) {
  // Damaged files of an earlier run, recognised by the names of their attributes.
  const std::string begin = "\x76\x2f\x31\x01 vdbeam:sceneHash ";
  write("o.0001.checkpoint.exr", begin + "vdbeam:film");
  write("o.0001.snapshot.exr", begin + "vdbeam:stoppedBy");
  ASSERT_EQ(render({fog_vdb, "-f", "1", "-o", "o.####.exr", "--passes", "1", "-q"}).code, 0);
  EXPECT_EQ(files(), Names{"o.0001.exr"});
}

} // namespace
} // namespace vdbeam
