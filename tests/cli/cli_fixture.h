#pragma once

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sstream>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace vdbeam::test {

struct ProgramResult {
  int code = -1; ///< exit code; 128 + signal where one killed it
  bool killed = false;
  double processor_seconds = 0;
  std::string out, error;

  /// Lines on stderr.
  std::size_t error_lines() const {
    return static_cast<std::size_t>(std::count(error.begin(), error.end(), '\n'));
  }
};

/// Runs the program in a fresh folder.
class CliTest : public ::testing::Test {
protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "vdbeam_cli_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
    std::filesystem::remove_all(folder_);
  }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(file(name), std::ios::binary) << text;
    return file(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream stream(file(name), std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  /// Names in the folder, but for those of the captured streams.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
      if (!entry.path().filename().string().starts_with("std"))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0)
      return child;
    // Root may write anywhere, which would hide what permissions do; others need not drop this.
    prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0);
    prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH, 0, 0, 0);
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    std::vector<char*> words{const_cast<char*>(VDBEAM_BINARY)};
    for (const std::string& argument : arguments)
      words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    if (chdir(folder_.c_str()) != 0 || !std::freopen("stdout.txt", "w", stdout) ||
        !std::freopen("stderr.txt", "w", stderr))
      _exit(99);
    execv(VDBEAM_BINARY, words.data());
    _exit(98);
  }
  ProgramResult finish(pid_t child) const {
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    ProgramResult result;
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    result.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    result.killed = WIFSIGNALED(status);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = read("stdout.txt");
    result.error = read("stderr.txt");
    return result;
  }
  /// True once the child came to its end; `finish` still has to be called.
  static bool has_ended(pid_t child) {
    siginfo_t info{};
    return waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
           info.si_pid == child;
  }
  /// Waits for something that the child does, as long as it runs: a busy machine may take its time.
  template <class Condition>
  static void wait_until(pid_t child, const Condition& holds) {
    while (!holds() && !has_ended(child))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  /// Waits until the program said something on stderr, which it does once rendering begins.
  void wait_for_output(pid_t child) const {
    wait_until(child, [&] { return !read("stderr.txt").empty(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  /// Seconds of processor time that the child has taken so far.
  static double processor_seconds(pid_t child) {
    clockid_t clock{};
    timespec time{};
    if (clock_getcpuclockid(child, &clock) != 0 || clock_gettime(clock, &time) != 0)
      return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  ProgramResult run(const std::vector<std::string>& arguments) const {
    return finish(start(arguments));
  }
  /// `render SCENE` at a size and quality that take no time.
  ProgramResult render(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "render");
    for (const char* option : {"--resolution", "32x18", "--set", "render.photons=2000"})
      arguments.push_back(option);
    return run(arguments);
  }

  const std::string cloud = VDBEAM_SOURCE_DIR "/data/cloud.toml";
  const std::string cloud_vdb = VDBEAM_SOURCE_DIR "/data/cloud.vdb";
  /// A small volume, since most of a short render of the cloud is reading it.
  const std::string fog_vdb = VDBEAM_SOURCE_DIR "/data/fog.vdb";
  const std::string smoke_pattern = VDBEAM_SOURCE_DIR "/data/smoke/smoke.####.vdb";
  std::filesystem::path folder_;
};

} // namespace vdbeam::test
