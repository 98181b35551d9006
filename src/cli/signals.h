#pragma once

#include <atomic>

namespace vdbeam::cli {

/// Makes SIGINT and SIGTERM ask for an end after the pass in progress; a second one kills at once.
/// A signal that was ignored when the program started stays ignored.
void handle_signals();

/// True after the first signal.
const std::atomic<bool>& stop_requested();

/// 130 after SIGINT, 143 after SIGTERM, else 0.
int signal_exit_code();

} // namespace vdbeam::cli
