#include "cli_fixture.h"
#include "vdbeam/image_file.h"

namespace vdbeam {
namespace {

using Names = std::vector<std::string>;
namespace fs = std::filesystem;

/// Jobs whose frames are split by passes, their tasks run by hand.
class SplitJob : public test::CliTest {
protected:
  void SetUp() override {
    CliTest::SetUp();
    fs::copy_file(fog_vdb, folder_ / "c.vdb");
    write("s.toml", "[[volume]]\nfile = 'c.vdb'\nextinction = 40\n[[light]]\ntype = "
                    "'environment'\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\n");
  }
  void submit(const std::string& passes, const Names& more = {}) const {
    Names words{"farm",
                "slurm",
                "s.toml",
                "-f",
                "1-2",
                "-o",
                "o.####.exr",
                "--splits",
                "2",
                "--job",
                "job.sh",
                "--program",
                VDBEAM_BINARY,
                "--resolution",
                "24x16",
                "--set",
                "render.photons=500",
                "--passes",
                passes,
                "--threads=1",
                "--chunk=2",
                "--memory",
                "256"};
    words.insert(words.end(), more.begin(), more.end());
    const auto result = run(words);
    ASSERT_EQ(result.code, 0) << result.error;
  }
  /// The exit code of one array's only task.
  int task(const std::string& part) const {
    const std::string command = "cd '" + folder_.string() + "' && SLURM_JOB_ID=1 " +
                                "SLURM_ARRAY_TASK_ID=0 VDBEAM_PART=" + part +
                                " bash job.sh >log.txt 2>&1";
    const int status = std::system(command.c_str());
    return WEXITSTATUS(status);
  }
  void run_all() const {
    for (const char* part : {"0", "1", "merge"})
      ASSERT_EQ(task(part), 0) << read("log.txt");
  }
  /// The frames are those of an undivided render, and nothing else lies around.
  void expect_like_whole(const std::string& passes, const Names& more = {}) const {
    Names words{"render",
                "s.toml",
                "-f",
                "1-2",
                "-o",
                "w.####.exr",
                "-q",
                "--resolution",
                "24x16",
                "--set",
                "render.photons=500",
                "--passes",
                passes};
    words.insert(words.end(), more.begin(), more.end());
    ASSERT_EQ(run(words).code, 0);
    for (const char* frame : {"0001", "0002"}) {
      const Image joined = read_image(file(std::string("o.") + frame + ".exr"));
      const Image whole = read_image(file(std::string("w.") + frame + ".exr"));
      for (const char* channel : {"R", "G", "B", "A"})
        EXPECT_EQ(joined.find(channel)->data, whole.find(channel)->data) << frame << channel;
      EXPECT_EQ(joined.metadata.at("vdbeam:sceneHash"), whole.metadata.at("vdbeam:sceneHash"));
      fs::remove(folder_ / (std::string("w.") + frame + ".exr"));
    }
    for (const std::string& name : files())
      EXPECT_EQ(name.find("passes_"), std::string::npos) << name;
  }
};

TEST_F(SplitJob, SubmittedAgainRendersNothing) {
  submit("4");
  run_all();
  expect_like_whole("4");
  const std::string first = read("o.0001.exr");
  const auto written = fs::last_write_time(folder_ / "o.0001.exr");
  fs::last_write_time(folder_ / "s.toml", written + std::chrono::hours(1)); // touched, not changed
  run_all();
  EXPECT_EQ(fs::last_write_time(folder_ / "o.0001.exr"), written);
  EXPECT_EQ(read("o.0001.exr"), first);
}

TEST_F(SplitJob, OtherPassesAndSettingsAreRenderedAgain) {
  submit("4");
  run_all();
  submit("6");
  run_all();
  expect_like_whole("6");
  submit("6", {"--set", "volume.0.extinction=200"});
  run_all();
  expect_like_whole("6", {"--set", "volume.0.extinction=200"});
}

TEST_F(SplitJob, AReplacedVolumeIsRenderedAgain) {
  submit("4");
  run_all();
  fs::copy_file(VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb", folder_ / "c.vdb",
                fs::copy_options::overwrite_existing);
  // A simulation's file may be older than the picture.
  fs::last_write_time(folder_ / "c.vdb",
                      fs::last_write_time(folder_ / "s.toml") - std::chrono::hours(1));
  run_all();
  expect_like_whole("4");
}

TEST_F(SplitJob, StalePartsAreNotMerged) {
  submit("4");
  ASSERT_EQ(task("0"), 0) << read("log.txt");
  ASSERT_EQ(task("1"), 0) << read("log.txt");
  fs::copy_file(VDBEAM_SOURCE_DIR "/data/smoke/smoke.0024.vdb", folder_ / "c.vdb",
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(task("merge"), 3) << read("log.txt");
  EXPECT_NE(read("log.txt").find("volumes that have changed"), std::string::npos)
      << read("log.txt");
  EXPECT_FALSE(exists("o.0001.exr"));
  run_all();
  expect_like_whole("4");
}

TEST_F(SplitJob, FarmReportsAtOnceWhichFramesHaveNoVolume) {
  for (const char* name : {"v.0001.vdb", "v.0002.vdb", "v.0005.vdb"})
    fs::copy_file(fog_vdb, folder_ / name);
  const auto farm = [&](const std::string& frames, const Names& more = {}) {
    Names words{"farm", "slurm", "v.toml", "-f", frames, "-o", "o.####.exr", "--job", "job.sh"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  };
  write("v.toml", "[[volume]]\nfile = 'v.####.vdb'\n[[light]]\ntype = 'environment'\n");
  const auto noted = farm("1-6");
  EXPECT_EQ(noted.code, 0) << noted.error;
  EXPECT_NE(noted.error.find("note: 3 of 6 frames (3,4,6) cannot be rendered"), std::string::npos)
      << noted.error;
  EXPECT_NE(noted.error.find("v.0003.vdb"), std::string::npos) << noted.error;
  EXPECT_EQ(farm("1,2,5").error.find("cannot be rendered"), std::string::npos);
  EXPECT_EQ(farm("1-6", {"--also=--missing=hold"}).error.find("cannot be rendered"),
            std::string::npos);
}

} // namespace
} // namespace vdbeam
