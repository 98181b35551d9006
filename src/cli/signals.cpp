#include "cli/signals.h"

#include <csignal>

namespace vdbeam::cli {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> snapshot{false};
std::atomic<int> received{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int number) {
  if (number == SIGUSR1) {
    snapshot = true;
    return;
  }
  int none = 0;
  if (!received.compare_exchange_strong(none, number)) {
    std::signal(number, SIG_DFL);
    std::raise(number);
    return;
  }
  stop = true;
}

} // namespace

void handle_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGUSR1}) {
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
