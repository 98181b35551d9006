#include "farm/engines.h"
#include "farm/openjd_range.h"
#include "support/temp_folder.h"
#include "vdbeam/error.h"

#include <gtest/gtest.h>
#include <numeric>
#include <sys/wait.h>

namespace vdbeam {
namespace {

FarmJob make_job(int frames) {
  FarmJob job;
  job.name = "smoke";
  job.folder = "/show/shot 1";
  job.scene = "/show/shot 1/smoke.toml";
  job.output = "/show/shot 1/out/smoke.####.exr";
  job.logs = "/show/shot 1/out";
  job.passes = 64;
  job.frames.resize(static_cast<std::size_t>(frames));
  std::iota(job.frames.begin(), job.frames.end(), 1);
  return job;
}

TEST(FarmJob, ChunksCoverEveryFrame) {
  FarmJob job = make_job(10);
  for (const auto& [chunk, tasks] : {std::pair{1, 10}, {3, 4}, {5, 2}, {10, 1}, {11, 1}}) {
    job.chunk = chunk;
    EXPECT_EQ(task_count(job), tasks) << chunk;
  }
}

TEST(FarmJob, FramesThatArePlannedDiffer) {
  using Frames = std::vector<int>;
  EXPECT_EQ(frames_to_plan({1, 2, 3, 4, 5}, true), (Frames{1, 3, 5}));
  EXPECT_EQ(frames_to_plan({1, 2}, true), (Frames{1, 2}));
  EXPECT_EQ(frames_to_plan({7}, true), Frames{7});
  EXPECT_EQ(frames_to_plan({1, 2, 3, 4, 5}, false), Frames{1});
}

TEST(FarmJob, PassRangesAreEvenAndComplete) {
  FarmJob job = make_job(1);
  EXPECT_EQ(pass_ranges(job), std::vector<std::string>{""});
  job.splits = 2;
  EXPECT_EQ(pass_ranges(job), (std::vector<std::string>{"0-31", "32-63"}));
  job.passes = 7;
  job.splits = 3;
  EXPECT_EQ(pass_ranges(job), (std::vector<std::string>{"0-2", "3-4", "5-6"}));
  job.splits = 7;
  EXPECT_EQ(pass_ranges(job).back(), "6-6");
  job.splits = 8;
  EXPECT_THROW(pass_ranges(job), InputError);
}

TEST(FarmJob, PartialsKeepTheFramesPlace) {
  EXPECT_EQ(partial_path("/a/smoke.####.exr", "0-31"), "/a/smoke.####.passes_0-31.exr");
  EXPECT_EQ(partial_path("/a/still.exr", "3-3"), "/a/still.passes_3-3.exr");
  EXPECT_EQ(partial_path("/a/still.exr", ""), "/a/still.exr");
}

TEST(FarmJob, MemoryFollowsThePlan) {
  constexpr std::uint64_t mib = 1024 * 1024;
  MemoryPlan plan;
  plan.program = 50 * mib;
  plan.reading = 850 * mib;
  plan.rendering = 540 * mib;
  plan.film = 100 * mib;
  // Another frame's 800 beside the 540 of this one: 1340; a quarter more: 1675.
  EXPECT_EQ(task_memory_mib(plan), 1728u);
  EXPECT_EQ(merge_memory_mib(plan), 640u);
}

TEST(FarmJob, ShellWordsComeBackAsTheyWere) {
  const test::TempFolder folder;
  for (const std::string word :
       {"plain", "two words", "it's", "$HOME", "a\"b", "*", "", "back\\slash", "a;b", "~", "#"}) {
    const std::string command =
        "printf %s " + shell_word(word) + " > " + shell_word(folder.file("word"));
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    EXPECT_EQ(test::read_bytes(folder.file("word")), word);
  }
}

TEST(OpenjdRange, ShortensStepsAndNeverOverlaps) {
  EXPECT_EQ(openjd_range({7}), "7");
  EXPECT_EQ(openjd_range({1, 2, 3, 4}), "1-4");
  EXPECT_EQ(openjd_range({1, 2}), "1,2");
  EXPECT_EQ(openjd_range({1, 3, 5, 7, 8, 9}), "1-7:2,8,9");
  EXPECT_EQ(openjd_range({1, 5, 9, 10, 11, 12}), "1-9:4,10-12");
  EXPECT_EQ(openjd_range({1, 2, 4, 8, 16}), "1,2,4,8,16");
  EXPECT_EQ(openjd_range({-5, -4, -3, 0}), "-5--3,0");
}

TEST(Slurm, HeaderSaysWhatTheJobNeeds) {
  FarmJob job = make_job(24);
  job.chunk = 5;
  job.running = 3;
  job.threads = 16;
  job.memory_mib = 2048;
  job.time_limit = 3601;
  const std::string script = slurm_script(job);
  for (const char* line :
       {"#!/bin/bash\n", "#SBATCH --array=0-4%3\n", "#SBATCH --cpus-per-task=16\n",
        "#SBATCH --mem=2048M\n", "#SBATCH --time=61\n", "#SBATCH --requeue\n",
        "#SBATCH --signal=B:TERM@120\n", "#SBATCH --chdir=\"/show/shot 1\"\n",
        "#SBATCH --output=\"/show/shot 1/out/%x_%A_%a.log\"\n"})
    EXPECT_NE(script.find(line), std::string::npos) << line;
  EXPECT_EQ(slurm_submission(job), "sbatch FILE");
  job.splits = 2;
  EXPECT_EQ(slurm_submission(job), "bash FILE");
  job.time_limit = 60;
  EXPECT_THROW(slurm_script(job), InputError);
}

/// Runs every task of a job with a program that writes down what it was asked to do.
std::string run_tasks(const FarmJob& job, const test::TempFolder& folder,
                      const std::string& environment) {
  test::write_bytes(folder.file("job.sh"), slurm_script(job));
  for (int task = 0; task < task_count(job); ++task) {
    const std::string command =
        environment + " SLURM_JOB_ID=1 SLURM_ARRAY_TASK_ID=" + std::to_string(task) + " bash " +
        shell_word(folder.file("job.sh")) + " > " + shell_word(folder.file("log"));
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
  }
  return test::read_bytes(folder.file("words"));
}

void make_program(FarmJob& job, const test::TempFolder& folder) {
  job.program = folder.file("program");
  test::write_bytes(job.program, "#!/bin/bash\necho \"$1: ${*:2}\" >> " +
                                     shell_word(folder.file("words")) + "\n");
  std::filesystem::permissions(job.program, std::filesystem::perms::owner_all);
}

TEST(Slurm, TasksRenderTheirFrames) {
  const test::TempFolder folder;
  FarmJob job = make_job(0);
  make_program(job, folder);
  job.frames = {-3, -1, 1, 2, 3, 10, 1000};
  job.chunk = 3;
  job.options = {"--set=volume.0.grid=my density", "--seed=5"};
  const std::string words = run_tasks(job, folder, "");
  const auto line = [&](const std::string& frames) {
    return "render: /show/shot 1/smoke.toml --set=volume.0.grid=my density --seed=5 --frames=" +
           frames +
           " -o /show/shot 1/out/smoke.####.exr --skip-existing --checkpoint 300s"
           " --progress plain\n";
  };
  EXPECT_EQ(words, line("-3,-1,1") + line("2,3,10") + line("1000"));
}

TEST(Slurm, SplitTasksRenderTheirPassesAndMerge) {
  const test::TempFolder folder;
  FarmJob job = make_job(3);
  make_program(job, folder);
  job.chunk = 2;
  job.splits = 2;
  EXPECT_EQ(run_tasks(job, folder, "VDBEAM_PART=1"),
            "render: /show/shot 1/smoke.toml --frames=1,2 -o /show/shot 1/out/"
            "smoke.####.passes_32-63.exr --pass-range 32-63 --skip-existing --skip-merged "
            "/show/shot 1/out/smoke.####.exr --checkpoint 300s --progress plain\n"
            "render: /show/shot 1/smoke.toml --frames=3 -o /show/shot 1/out/"
            "smoke.####.passes_32-63.exr --pass-range 32-63 --skip-existing --skip-merged "
            "/show/shot 1/out/smoke.####.exr --checkpoint 300s --progress plain\n");
  test::write_bytes(folder.file("words"), "");
  const auto merge = [](const std::string& frames) {
    return "render: /show/shot 1/smoke.toml --frames=" + frames +
           " -o /show/shot 1/out/smoke.####.exr --skip-existing "
           "--from-parts=/show/shot 1/out/smoke.####.passes_0-31.exr "
           "--from-parts=/show/shot 1/out/smoke.####.passes_32-63.exr --progress plain\n";
  };
  EXPECT_EQ(run_tasks(job, folder, "VDBEAM_PART=merge"), merge("1,2") + merge("3"));
}

TEST(Slurm, TaskPassesTerminationOnAndKeepsTheExitCode) {
  const test::TempFolder folder;
  FarmJob job = make_job(1);
  job.program = folder.file("program");
  test::write_bytes(job.program, "#!/bin/bash\ntrap 'exit 143' TERM\ntouch " +
                                     shell_word(folder.file("ready")) +
                                     "\nwhile :; do sleep 0.05; done\n");
  std::filesystem::permissions(job.program, std::filesystem::perms::owner_all);
  test::write_bytes(folder.file("job.sh"), slurm_script(job));
  const std::string command =
      "SLURM_JOB_ID=1 SLURM_ARRAY_TASK_ID=0 bash " + shell_word(folder.file("job.sh")) + " > " +
      shell_word(folder.file("log")) + " & while [ ! -e " + shell_word(folder.file("ready")) +
      " ]; do sleep 0.05; done; kill -TERM $!; wait $!";
  const int status = std::system(("bash -c " + shell_word(command)).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 143);
}

} // namespace
} // namespace vdbeam
