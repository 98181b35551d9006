#include "console/heartbeat.h"

#include "console/streams.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <sys/time.h>

namespace vdbeam::cli {
namespace {

/// Line that the signal handler writes. Whoever finds it held does without: the handler skips a
/// beat, the program a change.
struct Line {
  std::array<char, 512> text;
  std::size_t length = 0;
  std::atomic_flag held = ATOMIC_FLAG_INIT;
} beat_line;

extern "C" void beat(int) {
  const int error = errno;
  if (!beat_line.held.test_and_set()) {
    log_from_signal({beat_line.text.data(), beat_line.length});
    beat_line.held.clear();
  }
  errno = error;
}

void set_timer(std::chrono::seconds seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = timer.it_interval.tv_sec = seconds.count();
  setitimer(ITIMER_REAL, &timer, nullptr);
}

} // namespace

Heartbeat::Heartbeat(const std::string& line) {
  set(line);
  struct sigaction action {};
  action.sa_handler = beat;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGALRM, &action, nullptr);
  begin_anew();
}

Heartbeat::~Heartbeat() {
  set_timer(std::chrono::seconds(0));
}

void Heartbeat::set(const std::string& line) {
  if (beat_line.held.test_and_set())
    return;
  beat_line.length = std::min(line.size(), beat_line.text.size() - 1);
  std::transform(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(beat_line.length),
                 beat_line.text.begin(), [](char c) { return c == '\n' || c == '\r' ? ' ' : c; });
  beat_line.text[beat_line.length++] = '\n';
  beat_line.held.clear();
}

void Heartbeat::begin_anew() {
  set_timer(heartbeat_interval);
}

} // namespace vdbeam::cli
