#include "console/streams.h"

#include "console/terminal.h"
#include "text/printable.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <mutex>
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

/// A stream that a render can do without: a reader that stands still costs lines, never time.
/// Making the descriptor non-blocking would do so for every program that shares it, so each write
/// is no longer than what a pipe that is ready takes whole.
class LossyStream {
public:
  explicit LossyStream(int descriptor, bool reports_loss)
      : descriptor_(descriptor), reports_loss_(reports_loss) {}

  void write(std::string_view text) {
    const std::lock_guard lock(mutex_);
    while (busy_.test_and_set()) { // the signal handler of another thread writes its line
    }
    write_all_lines(text);
    busy_.clear();
  }

  /// May be called by a signal handler. Nothing is written where the stream is in use or not ready.
  void write_at_once(std::string_view line) {
    if (busy_.test_and_set())
      return;
    pollfd wait{descriptor_, POLLOUT, 0};
    if (poll(&wait, 1, 0) > 0)
      (void)write_piece(line);
    busy_.clear();
  }

private:
  void write_all_lines(std::string_view text) {
    if (lost_ > 0 && reports_loss_) {
      const std::string report = fmt::format("{}({} of the log lost: nobody read it)\n",
                                             cut_ ? "\n" : "", lines_text(lost_));
      if (ready() && write_piece(report) == report.size()) {
        lost_ = 0;
        cut_ = false;
      }
    }
    if (cut_ && !reports_loss_ && ready() && write_piece("\n") == 1)
      cut_ = false; // the rest of the line that was cut is lost, the next one begins a line
    while (!text.empty()) {
      const std::size_t written =
          ready() ? write_piece(text.substr(0, static_cast<std::size_t>(PIPE_BUF))) : 0;
      if (written == 0) {
        lost_ += std::max<std::size_t>(
            1, static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
        return;
      }
      text.remove_prefix(written);
      cut_ = !text.empty();
    }
    if (!reports_loss_) {
      lost_ = 0;
      cut_ = false;
    }
  }

  static std::string lines_text(std::size_t lines) {
    return lines == 1 ? "1 line" : fmt::format("{} lines", lines);
  }

  /// A reader that is only slow gets some time; one that has missed lines already gets none.
  bool ready() const {
    constexpr int patience = 200; // milliseconds
    pollfd wait{descriptor_, POLLOUT, 0};
    int count = 0;
    do
      count = poll(&wait, 1, lost_ > 0 ? 0 : patience);
    while (count < 0 && errno == EINTR);
    return count > 0;
  }

  /// How much was written; nothing where that is not possible.
  std::size_t write_piece(std::string_view piece) const {
    for (;;) {
      const ssize_t written = ::write(descriptor_, piece.data(), piece.size());
      if (written >= 0 || errno != EINTR)
        return written > 0 ? static_cast<std::size_t>(written) : 0;
    }
  }

  std::mutex mutex_;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  int descriptor_;
  bool reports_loss_;
  std::size_t lost_ = 0; ///< lines since the last that was written
  bool cut_ = false;     ///< the last line has its beginning only
};

LossyStream& log_stream() {
  static LossyStream stream(STDERR_FILENO, true);
  return stream;
}

LossyStream& progress_stream() {
  static LossyStream stream(STDOUT_FILENO, false); // an engine reads nothing but its own words
  return stream;
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
  (void)log_stream();                // made before any signal handler may want it
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void log_text(std::string_view text) {
  log_stream().write(text);
}

void log_from_signal(std::string_view line) {
  log_stream().write_at_once(line);
}

void log_line(std::string_view line) {
  log_text(printable_line(line) + '\n');
}

void log_error(std::string_view line) {
  log_text(error_line(printable_line(line)) + '\n');
}

void progress_text(std::string_view text) {
  progress_stream().write(text);
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
