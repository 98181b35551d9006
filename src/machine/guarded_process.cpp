#include "machine/guarded_process.h"

#include "machine/stop_reading.h"
#include "machine/stopwatch.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <ucontext.h>
#include <unistd.h>

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <optional>

namespace vdbeam {

namespace {

enum class Outcome : std::uint32_t {
  done = 1,
  input_error,
  frame_error,
  no_memory,
  no_room,
  no_descriptors,
  exception
};

/// The child's last words; small enough that a pipe takes them whole.
struct Message {
  Outcome outcome = Outcome::done;
  std::array<char, 2000> text{};
};

/// The child's state, in globals because the functions that need it (a terminate handler and a
/// context's entry) take no arguments. Only ever set in a child.
const std::function<void(int)>* child_work = nullptr;
int child_output = -1;
int child_pipe = -1;

[[noreturn]] void leave(Outcome outcome, const char* text) {
  Message message;
  message.outcome = outcome;
  std::strncpy(message.text.data(), text, message.text.size() - 1);
  const ssize_t written = ::write(child_pipe, &message, sizeof message);
  ::_exit(written == sizeof message ? 0 : 1);
}

/// Whether the reader failed because no more files may be open (`ulimit -n`): what it had open
/// still is, since nothing has been destroyed.
bool lacks_descriptors() {
  const Descriptor one_more(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  return one_more.get() < 0 && (errno == EMFILE || errno == ENFILE);
}

[[noreturn]] void report_exception() {
  const bool no_descriptors = lacks_descriptors();
  try {
    std::rethrow_exception(std::current_exception());
  } catch (const InputError& error) {
    leave(Outcome::input_error, error.what());
  } catch (const MemoryFileFull&) {
    leave(Outcome::no_room, "");
  } catch (const FrameError& error) {
    leave(Outcome::frame_error, error.what());
  } catch (const std::bad_alloc&) {
    leave(Outcome::no_memory, "");
  } catch (const std::exception& error) {
    if (no_descriptors)
      leave(Outcome::no_descriptors, "");
    leave(Outcome::exception, error.what());
  } catch (...) {
    leave(Outcome::exception, "unknown");
  }
}

void run_work() {
  (*child_work)(child_output);
  leave(Outcome::done, "");
}

/// Runs the work on a stack of its own. There an exception that nothing catches finds no frame to
/// unwind to, so the terminate handler gets it while nothing is destroyed yet: destroying half-read
/// OpenVDB trees would enter TBB, whose other threads do not exist in this process.
[[noreturn]] void run_on_own_stack() {
  std::set_terminate(report_exception);
  constexpr std::size_t bytes = std::size_t(16) << 20;
  void* stack = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (stack == MAP_FAILED)
    leave(Outcome::no_memory, "");
  ::ucontext_t context;
  ::getcontext(&context);
  context.uc_stack.ss_sp = stack;
  context.uc_stack.ss_size = bytes;
  context.uc_link = nullptr;
  ::makecontext(&context, run_work, 0);
  ::setcontext(&context);
  ::_exit(1);
}

/// `slack` goes to the hard limit: at the hard one of RLIMIT_CPU comes a SIGKILL that says nothing.
void limit(int resource, std::uint64_t value, std::uint64_t slack = 0) {
  rlimit old;
  if (::getrlimit(static_cast<__rlimit_resource>(resource), &old) != 0)
    return;
  const rlimit now{std::min<rlim_t>(value, old.rlim_max),
                   std::min<rlim_t>(value + slack, old.rlim_max)};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &now);
}

std::uint64_t address_space_bytes() {
  const Descriptor file(::open("/proc/self/statm", O_RDONLY | O_CLOEXEC));
  std::array<char, 64> text{};
  if (::read(file.get(), text.data(), text.size() - 1) <= 0)
    return 0;
  return std::strtoull(text.data(), nullptr, 10) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// Where memory runs out all the same, the child should go, not the renderer.
void volunteer_for_out_of_memory_killer() {
  const Descriptor file(::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
  const char score[] = "1000";
  if (file.get() >= 0 && ::write(file.get(), score, sizeof score - 1) < 0)
    return; // not allowed here; the limits below still hold
}

[[noreturn]] void be_the_child(pid_t parent, const GuardLimits& limits) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent)
    ::_exit(1);
  for (int number = 1; number < 32; ++number)
    ::signal(number, SIG_DFL);
  // An interrupt reaches the whole process group; the parent decides what it means. SIGXFSZ
  // ignored makes a write beyond the limit an error.
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXFSZ, SIGPIPE,
                           SIGALRM, SIGVTALRM, SIGPROF})
    ::signal(number, SIG_IGN);
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, STDOUT_FILENO);
  ::dup2(null, STDERR_FILENO);
  volunteer_for_out_of_memory_killer();
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, limits.bytes);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(std::max(limits.cpu_seconds, 1.0))), 1);
  limit(RLIMIT_AS, address_space_bytes() + limits.bytes);
  run_on_own_stack();
}

/// The parent's end: a child process, ended and reaped at the latest by the destructor.
class Child {
public:
  Child(pid_t id, Descriptor pipe) : id_(id), pipe_(std::move(pipe)) {}
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { end(); }

  /// Waits for the message; nothing where the child died without one or the time is over. Throws
  /// Stopped.
  std::optional<Message> wait(const GuardLimits& limits);
  /// Kills the child if it still runs. Returns its wait status, or -1 where someone else took it.
  int end() {
    if (!reaped_)
      ::kill(id_, SIGKILL);
    reap(0);
    return status_;
  }
  bool died() const { return reaped_; }

private:
  void reap(int options) {
    pid_t found = 0;
    while (!reaped_ && (found = ::waitpid(id_, &status_, options)) < 0 && errno == EINTR) {
    }
    if (found < 0)
      status_ = -1;
    reaped_ = reaped_ || found != 0;
  }
  std::optional<Message> receive(int milliseconds);

  pid_t id_;
  Descriptor pipe_;
  int status_ = -1;
  bool reaped_ = false;
};

std::optional<Message> Child::receive(int milliseconds) {
  pollfd ready{pipe_.get(), POLLIN, 0};
  Message message;
  if (::poll(&ready, 1, milliseconds) <= 0 || !(ready.revents & POLLIN) ||
      ::read(pipe_.get(), &message, sizeof message) != sizeof message)
    return std::nullopt;
  message.text.back() = 0;
  return message;
}

/// Throws Stopped where reading is to end.
void check_stop(const GuardLimits& limits) {
  if (limits.stop)
    limits.stop->check();
  StopReading::check();
}

std::optional<Message> Child::wait(const GuardLimits& limits) {
  // A queue that suspends the job (SIGSTOP) stops both processes, so a look at the clock that comes
  // late counts as one second: the child could not work meanwhile.
  constexpr double longest_step = 1;
  double used = 0, last = 0;
  for (const Stopwatch watch; used < limits.seconds;) {
    const double now = watch.seconds();
    used += std::min(now - last, longest_step);
    last = now;
    // A child that dies says nothing, and the pipe may stay open in a sibling forked meanwhile, so
    // its death is looked for now and then.
    if (auto message = receive(20))
      return message;
    reap(WNOHANG);
    if (reaped_)
      return receive(0);
    check_stop(limits);
  }
  return receive(0); // the answer may have come since the last look
}

/// One line for a terminal, whatever a broken file put in it: no control characters.
std::string printable(std::string text) {
  for (char& c : text)
    if (const auto code = static_cast<unsigned char>(c); code < 0x20 || code == 0x7f)
      c = code == '\n' ? ' ' : '?';
  return text;
}

/// Remedy if the system refuses a process, a pipe or an open file.
const char* remedy_for(int error) {
  switch (error) {
  case EMFILE:
  case ENFILE:
    return "; allow more open files (ulimit -n)";
  case EAGAIN:
    return "; allow more processes (ulimit -u)";
  case ENOMEM:
    return "; free some memory";
  default:
    return "";
  }
}

[[noreturn]] void fail_to_start(const std::string& label, const char* what) {
  const int error = errno;
  throw FrameError(fmt::format("{}: cannot be read: {}: {}{}", label, what, std::strerror(error),
                               remedy_for(error)));
}

/// Error if the result did not fit into the file in memory, to which `ulimit -f` applies too.
[[noreturn]] void throw_no_room(const std::string& label, const GuardLimits& limits) {
  rlimit own{};
  if (::getrlimit(RLIMIT_FSIZE, &own) == 0 && own.rlim_max < limits.bytes)
    throw FrameError(fmt::format("{}: reading needs files in memory of more than the {} bytes that "
                                 "the limit on the size of files allows; raise it (ulimit -f)",
                                 label, own.rlim_max));
  throw FrameError(fmt::format("{}: reading gives more than {:.2f} GiB; the file is corrupt, or "
                               "larger than the limit",
                               label, static_cast<double>(limits.bytes) / (1 << 30)));
}

[[noreturn]] void throw_failure(const std::string& label, const GuardLimits& limits,
                                const std::optional<Message>& message, bool died, int status) {
  const double gib = static_cast<double>(limits.bytes) / (1 << 30);
  if (!message) {
    if (!died)
      throw FrameError(fmt::format("{}: reading took more than {:g} s; the file is corrupt, or the "
                                   "disk too slow",
                                   label, limits.seconds));
    if (status >= 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
      throw FrameError(fmt::format("{}: reading took more than {:g} s of processor time; the file "
                                   "is corrupt",
                                   label, std::ceil(limits.cpu_seconds)));
    if (status >= 0 && WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
      throw FrameError(label + ": the reader was killed; is the machine out of memory?");
    throw FrameError(label + ": the file is corrupt, it crashed the reader");
  }
  const std::string text = printable(message->text.data());
  switch (message->outcome) {
  case Outcome::input_error:
    throw InputError(text);
  case Outcome::frame_error:
    throw FrameError(text);
  case Outcome::no_room:
    throw_no_room(label, limits);
  case Outcome::no_descriptors:
    throw FrameError(
        fmt::format("{}: cannot be read: {}{}", label, std::strerror(EMFILE), remedy_for(EMFILE)));
  case Outcome::no_memory:
    throw FrameError(fmt::format("{}: reading needs more than {:.2f} GiB; the file is corrupt, or "
                                 "larger than the limit",
                                 label, gib));
  default:
    // OpenVDB's words for it would help nobody.
    throw FrameError(label + ": the file is corrupt or cut short; copy or export it again");
  }
}

} // namespace

MappedFile run_guarded(const std::string& label, const GuardLimits& limits,
                       const std::function<void(int)>& work) {
  check_stop(limits); // a small file would be read before anybody asks
  const Descriptor output = create_memory_file();
  if (output.get() < 0)
    fail_to_start(label, "no file in memory");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    fail_to_start(label, "no pipe to its reader");
  Descriptor read_end(ends[0]), write_end(ends[1]);

  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0)
    fail_to_start(label, "no process to read it in");
  if (id == 0) {
    child_work = &work;
    child_output = output.get();
    child_pipe = write_end.get();
    be_the_child(parent, limits);
  }
  write_end = Descriptor();
  Child child(id, std::move(read_end));
  const std::optional<Message> message = child.wait(limits);
  const bool died = child.died();
  const int status = child.end();
  if (!message || message->outcome != Outcome::done)
    throw_failure(label, limits, message, died, status);
  return MappedFile(output.get());
}

} // namespace vdbeam
