#pragma once

#include <nlohmann/json_fwd.hpp>

namespace vdbeam::cli {

/// Version of the events' protocol (docs/reference/progress.md). New events and keys leave it as it
/// is; it rises where an event or key changes its meaning or goes.
inline constexpr int events_protocol = 1;

/// Turns on the events of `--progress json`, for programs that run vdbeam: one JSON object a line
/// on stdout, which holds nothing else. The first is `start`.
void enable_events();
bool events_enabled();

/// Sends an event with these fields, which come after `event` and `t`, the seconds since the start.
/// Does nothing where events are off. A reader that stands still costs lines, never time. May be
/// called by any thread.
void send_event(const char* event, const nlohmann::ordered_json& fields);

/// The error that ends the program, with its exit code.
void send_error(const std::string& text, int exit_code);

/// The last event: the program ends with this code.
void send_end(int exit_code);

} // namespace vdbeam::cli
