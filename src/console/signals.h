#pragma once

#include <atomic>

namespace vdbeam::cli {

/// Makes SIGINT, SIGTERM and SIGHUP ask for an end soon, and SIGUSR1 for a snapshot; a second
/// signal to end kills at once. A signal that was ignored when the program started (`nohup`) stays
/// ignored.
void handle_signals();

/// True after the first signal to end.
const std::atomic<bool>& stop_requested();

/// True after SIGUSR1, until whoever serves it sets it back.
std::atomic<bool>& snapshot_requested();

/// 129 after SIGHUP, 130 after SIGINT, 143 after SIGTERM, else 0.
int signal_exit_code();

} // namespace vdbeam::cli
