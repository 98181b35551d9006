#include "console/signals.h"

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <thread>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> snapshot{false};
std::atomic<int> received{0};
std::atomic<std::int64_t> received_at{0}; ///< milliseconds; 0: never
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);

/// A queue may signal every process of a job, and a script of the job pass the signal on: two so
/// close to each other are one. On a busy machine some time may pass between them.
constexpr std::int64_t same_signal = 500;

std::int64_t milliseconds_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1 + std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1'000'000;
}

extern "C" void on_signal(int number) {
  if (number == SIGUSR1) {
    snapshot = true;
    return;
  }
  // The time decides who came first, so that no thread finds a first signal without its time.
  const std::int64_t now = milliseconds_now();
  std::int64_t never = 0;
  if (received_at.compare_exchange_strong(never, now)) {
    received = number;
    stop = true;
  } else if (now - received_at > same_signal) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
}

} // namespace

void handle_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN)
      continue;
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
}

void end_with_stdin() {
  std::thread([] {
    char dropped[256];
    ssize_t count = 0;
    do
      count = read(STDIN_FILENO, dropped, sizeof dropped);
    while (count > 0 || (count < 0 && errno == EINTR));
    on_signal(SIGTERM);
  }).detach();
}

const std::atomic<bool>& stop_requested() {
  return stop;
}

std::atomic<bool>& snapshot_requested() {
  return snapshot;
}

int signal_exit_code() {
  return received == 0 ? 0 : 128 + received;
}

} // namespace vdbeam::cli
