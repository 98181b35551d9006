#pragma once

#include <atomic>

namespace vdbeam::cli {

/// Makes SIGINT, SIGTERM and SIGHUP ask for an end soon, and SIGUSR1 for a snapshot; a second
/// signal to end kills at once. A signal that was ignored when the program started (`nohup`) stays
/// ignored.
void handle_signals();

/// Lets the end of the standard input act as SIGTERM: it comes also when the program that has
/// started this one is killed. What is read is dropped.
void end_with_stdin();

/// True after the first signal to end.
const std::atomic<bool>& stop_requested();

/// True after SIGUSR1, until whoever serves it sets it back.
std::atomic<bool>& snapshot_requested();

/// 129 after SIGHUP, 130 after SIGINT, 143 after SIGTERM, else 0.
int signal_exit_code();

} // namespace vdbeam::cli
