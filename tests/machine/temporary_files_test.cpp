#include "machine/temporary_files.h"

#include "machine/atomic_file.h"
#include "support/temp_folder.h"

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;

/// A process that is in the middle of writing a file.
class Writer {
public:
  explicit Writer(const std::string& path) {
    int ready[2];
    EXPECT_EQ(pipe(ready), 0);
    process_ = fork();
    if (process_ == 0) {
      AtomicFile file(path);
      file.write("half", 4);
      (void)!write(ready[1], "x", 1);
      while (true)
        pause();
    }
    char byte = 0;
    EXPECT_EQ(read(ready[0], &byte, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Writer() { end(); }
  void end() {
    if (process_ <= 0)
      return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
    process_ = 0;
  }

private:
  pid_t process_ = 0;
};

std::size_t file_count(const test::TempFolder& folder) {
  const fs::path path = fs::path(folder.file("x")).parent_path();
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), {}));
}

/// A whole output, written by a process of its own, which has not been in the folder before.
void write_output(const std::string& path) {
  const pid_t child = fork();
  if (child == 0) {
    AtomicFile file(path);
    file.write("whole", 5);
    file.commit();
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
}

void make_old(const std::string& path, int hours) {
  fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(hours));
}

TEST(TemporaryFiles, OfKilledProcessesAreRemovedAndOfLiveOnesNot) {
  const test::TempFolder folder;
  Writer dead(folder.file("a.exr")), alive(folder.file("a.exr"));
  ASSERT_EQ(file_count(folder), 2u);
  dead.end();
  write_output(folder.file("b.exr"));
  EXPECT_EQ(file_count(folder), 2u); // that of the live one, and b.exr
  EXPECT_EQ(test::read_bytes(folder.file("b.exr")), "whole");
  alive.end();
  write_output(folder.file("b.exr"));
  EXPECT_EQ(file_count(folder), 1u);
}

/// Beside files that are finished nothing is created.
TEST(TemporaryFiles, OfKilledProcessesAreRemovedWhereNothingIsWritten) {
  const test::TempFolder folder;
  Writer dead(folder.file("a.exr")), alive(folder.file("a.exr"));
  const std::string other = folder.file(".a.exr.00000000-1-0.tmp");
  test::write_bytes(other, "half");
  make_old(other, 1000); // of another machine, whose clock is not known
  dead.end();
  remove_dead_temporaries(fs::path(other).parent_path().string());
  EXPECT_EQ(file_count(folder), 2u);
  EXPECT_TRUE(fs::exists(other));
}

/// A live file's age does not matter, as long as its lock is seen.
TEST(TemporaryFiles, LocksCountMoreThanAge) {
  const test::TempFolder folder;
  const std::string name = folder.file(".a.exr.00000000-1-0.tmp");
  test::write_bytes(name, "half");
  make_old(name, 1000);
  const int descriptor = open(name.c_str(), O_RDWR);
  ASSERT_EQ(flock(descriptor, LOCK_EX), 0);
  write_output(folder.file("b.exr"));
  EXPECT_TRUE(fs::exists(name));
  close(descriptor);
}

TEST(TemporaryFiles, OfOtherMachinesStayForADay) {
  const test::TempFolder folder;
  const std::string young = folder.file(".a.exr.00000000-1-0.tmp"),
                    old = folder.file(".a.exr.00000000-1-1.tmp");
  for (const std::string& name : {young, old})
    test::write_bytes(name, "half");
  make_old(young, 23);
  make_old(old, 25);
  write_output(folder.file("b.exr"));
  EXPECT_TRUE(fs::exists(young));
  EXPECT_FALSE(fs::exists(old));
}

TEST(TemporaryFiles, NothingElseIsTouched) {
  const test::TempFolder folder;
  for (const char* name : {".a.exr.tmp", "a.exr", ".a.exr.12345678-1-0.tmp.bak", "a.1234-1.tmp",
                           ".a.exr.1234-5.tmp"}) {
    test::write_bytes(folder.file(name), "x");
    make_old(folder.file(name), 1000);
  }
  fs::create_symlink(folder.file("a.exr"), folder.file(".l.exr.00000000-1-1.tmp"));
  write_output(folder.file("b.exr"));
  EXPECT_EQ(file_count(folder), 7u);
}

} // namespace
} // namespace vdbeam
