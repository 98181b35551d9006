#include "cli/streams.h"

#include "cli/terminal.h"
#include "text/printable.h"
#include "vdbeam/error.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

/// 0, or errno of the failure. The C and C++ streams are not used: they keep what could not be
/// written and try it again later.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
      continue;
    }
    if (errno == EAGAIN || errno == EWOULDBLOCK) { // another program made the stream non-blocking
      pollfd wait{descriptor, POLLOUT, 0};
      (void)poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

[[noreturn]] void throw_unwritable(int error) {
  throw FrameError(fmt::format("standard output: cannot be written: {}", std::strerror(error)));
}

} // namespace

void guard_standard_streams() {
  // The mode is the wrong one on purpose: a command whose output is stdout must see that it fails.
  for (const auto& [descriptor, mode] :
       {std::pair(STDIN_FILENO, O_WRONLY), std::pair(STDOUT_FILENO, O_RDONLY),
        std::pair(STDERR_FILENO, O_RDONLY)})
    if (fcntl(descriptor, F_GETFD) < 0)
      (void)open("/dev/null", mode); // gets the lowest free number, which is this one
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void log_text(std::string_view text) {
  (void)write_all(STDERR_FILENO, text);
}

void log_line(std::string_view line) {
  log_text(printable_line(line) + '\n');
}

void log_error(std::string_view line) {
  log_text(error_line(printable_line(line)) + '\n');
}

void progress_text(std::string_view text) {
  (void)write_all(STDOUT_FILENO, text);
}

void write_stdout(std::string_view text) {
  if (const int error = write_all(STDOUT_FILENO, text); error != 0)
    throw_unwritable(error);
}

void print_output(std::string_view text) {
  const int error = write_all(STDOUT_FILENO, text);
  if (error == EPIPE) {
    std::signal(SIGPIPE, SIG_DFL);
    std::raise(SIGPIPE);
  }
  if (error != 0)
    throw_unwritable(error);
}

void print_text(std::string_view text) {
  print_output(printable_text(text));
}

} // namespace vdbeam::cli
