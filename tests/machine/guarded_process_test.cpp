#include "machine/guarded_process.h"

#include "vdbeam/error.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <new>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace vdbeam {
namespace {

constexpr std::uint64_t mib = std::uint64_t(1) << 20;
const GuardLimits ample{600, 600, 64 * mib};

/// The line of the FrameError that the work must end in.
std::string failure(const GuardLimits& limits, const std::function<void(int)>& work) {
  try {
    run_guarded("label", limits, work);
  } catch (const FrameError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no FrameError";
  return "";
}

void spin() {
  for (std::atomic<int> turns{0};; ++turns) {
  }
}

TEST(GuardedProcess, returns_what_was_written) {
  const std::string text(3 * mib, 'x');
  MappedFile file = run_guarded("label", ample, [&](int output) {
    write_all(output, text.data(), text.size());
    write_all(output, "end", 3);
  });
  ASSERT_EQ(file.size(), text.size() + 3);
  EXPECT_EQ(std::memcmp(file.data(), text.data(), text.size()), 0);
  EXPECT_EQ(std::memcmp(file.data() + text.size(), "end", 3), 0);
  EXPECT_EQ(run_guarded("label", ample, [](int) {}).size(), 0u);
}

TEST(GuardedProcess, ends_when_it_is_told_to_stop) {
  const std::atomic<bool> yes = true;
  const StopToken stop(&yes);
  GuardLimits limits = ample;
  limits.stop = &stop;
  EXPECT_THROW(run_guarded("label", limits, [](int) { spin(); }), Stopped);
}

TEST(GuardedProcess, errors_arrive_as_they_are) {
  EXPECT_THROW(run_guarded("label", ample, [](int) { throw InputError("x.vdb: no"); }), InputError);
  EXPECT_EQ(failure(ample, [](int) { throw FrameError("x.vdb: broken"); }), "x.vdb: broken");
  // OpenVDB's words stay away.
  const std::string corrupt = "label: the file is corrupt or cut short; copy or export it again";
  EXPECT_EQ(failure(ample, [](int) { throw std::runtime_error("odd\n\x01thing\xff"); }), corrupt);
  EXPECT_EQ(failure(ample, [](int) { throw 1; }), corrupt);
}

TEST(GuardedProcess, an_exception_ends_it_before_any_destructor) {
  struct Hangs {
    ~Hangs() { spin(); }
  };
  EXPECT_EQ(failure(ample,
                    [](int) {
                      const Hangs hangs;
                      throw std::runtime_error("first");
                    }),
            "label: the file is corrupt or cut short; copy or export it again");
}

TEST(GuardedProcess, crashes_are_errors) {
  EXPECT_EQ(failure(ample, [](int) { ::raise(SIGSEGV); }),
            "label: the file is corrupt, it crashed the reader");
  EXPECT_EQ(failure(ample, [](int) { std::abort(); }),
            "label: the file is corrupt, it crashed the reader");
  EXPECT_EQ(failure(ample, [](int) { ::_exit(0); }),
            "label: the file is corrupt, it crashed the reader");
  EXPECT_EQ(failure(ample, [](int) { ::raise(SIGKILL); }),
            "label: the reader was killed; is the machine out of memory?");
}

TEST(GuardedProcess, hangs_end_in_time) {
  EXPECT_EQ(failure({0.3, 30, 64 * mib}, [](int) { ::pause(); }),
            "label: reading took more than 0.3 s; the file is corrupt, or the disk too slow");
  EXPECT_EQ(failure({600, 1, 64 * mib}, [](int) { spin(); }),
            "label: reading took more than 1 s of processor time; the file is corrupt");
}

TEST(GuardedProcess, memory_is_limited) {
  const auto grow = [](int) {
    // Mapped, since the sanitizers' allocators have their own way out of memory; some room is left
    // for the exception.
    for (void* last = nullptr;;) {
      void* block =
          ::mmap(nullptr, 8 * mib, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (block == MAP_FAILED) {
        ::munmap(last, 8 * mib);
        throw std::bad_alloc();
      }
      last = block;
    }
  };
  EXPECT_EQ(failure(ample, grow), "label: reading needs more than 0.06 GiB; the file is corrupt, "
                                  "or larger than the limit");
  const std::string block(mib, 'x');
  EXPECT_EQ(
      failure(ample,
              [&](int output) {
                for (;;)
                  write_all(output, block.data(), block.size());
              }),
      "label: reading gives more than 0.06 GiB; the file is corrupt, or larger than the limit");
}

/// Runs in a process of its own, since a lowered limit stays: a limit of `ulimit`, and the line in
/// which it ends.
std::string failure_under(int resource, rlim_t most, const std::function<void(int)>& work) {
  const Descriptor answer = create_memory_file();
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{most, most};
    ::signal(SIGXFSZ, SIG_IGN);
    ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
    std::string line = "no error";
    try {
      run_guarded("label", ample, work);
    } catch (const std::exception& error) {
      line = error.what();
    }
    ::_exit(::write(answer.get(), line.data(), line.size()) < 0 ? 1 : 0);
  }
  ::waitpid(child, nullptr, 0);
  const MappedFile file(answer.get());
  return {reinterpret_cast<const char*>(file.data()), file.size()};
}

TEST(GuardedProcess, limits_of_the_shell_are_named) {
  EXPECT_EQ(
      failure_under(RLIMIT_FSIZE, 1000,
                    [](int output) {
                      const std::string bytes(2000, 'x');
                      write_all(output, bytes.data(), bytes.size());
                    }),
      "label: reading needs files in memory of more than the 1000 bytes that the limit on the "
      "size of files allows; raise it (ulimit -f)");
  const auto open_many = [](int) {
    while (::open("/dev/null", O_RDONLY) >= 0) {
    }
    throw std::runtime_error("cannot open the file"); // as OpenVDB puts it
  };
  EXPECT_EQ(failure_under(RLIMIT_NOFILE, 64, open_many),
            "label: cannot be read: Too many open files; allow more open files (ulimit -n)");
  EXPECT_EQ(failure_under(RLIMIT_NOFILE, 3, [](int) {}),
            "label: cannot be read: no file in memory: Too many open files; allow more open files "
            "(ulimit -n)");
}

TEST(GuardedProcess, interrupts_are_the_parents_affair) {
  run_guarded("label", ample, [](int) {
    ::raise(SIGINT);
    ::raise(SIGTERM);
  });
}

/// Forks while TBB's workers are busy, and throws in the children.
TEST(GuardedProcess, works_beside_busy_threads) {
  std::atomic<bool> stop{false};
  std::atomic<int> allocations{0};
  std::thread busy([&] {
    while (!stop)
      tbb::parallel_for(0, 1000, [&](int i) {
        const std::vector<int> some(static_cast<std::size_t>(1 + i % 100));
        allocations += static_cast<int>(some.size());
      });
  });
  for (int n = 0; n < 100; ++n) {
    const MappedFile file = run_guarded("label", ample, [](int output) {
      const std::vector<char> some(1000, 'x');
      write_all(output, some.data(), some.size());
    });
    EXPECT_EQ(file.size(), 1000u);
    failure(ample, [](int) { throw std::runtime_error("bad"); });
  }
  stop = true;
  busy.join();
}

TEST(MappedFile, gives_its_front_back) {
  const Descriptor memory = create_memory_file();
  const std::string text(16 * mib, 'x');
  write_all(memory.get(), text.data(), text.size());
  MappedFile file(memory.get());
  file.release_front(mib); // too little to be worth it
  EXPECT_EQ(static_cast<char>(file.data()[0]), 'x');
  file.release_front(10 * mib + 5);
  EXPECT_EQ(static_cast<char>(file.data()[0]), '\0');
  EXPECT_EQ(static_cast<char>(file.data()[10 * mib - 1]), '\0');
  EXPECT_EQ(static_cast<char>(file.data()[10 * mib]), 'x');
}

} // namespace
} // namespace vdbeam
