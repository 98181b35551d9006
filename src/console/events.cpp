#include "console/events.h"

#include "console/streams.h"
#include "machine/stopwatch.h"
#include "vdbeam/version.h"

#include <atomic>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace vdbeam::cli {
namespace {

using Json = nlohmann::ordered_json;

std::atomic<bool> enabled{false};
Stopwatch since_start;

} // namespace

void enable_events() {
  enabled = true;
  since_start.restart();
  send_event("start", {{"protocol", events_protocol}, {"version", version()}, {"pid", ::getpid()}});
}

bool events_enabled() {
  return enabled;
}

void send_event(const char* event, const Json& fields) {
  if (!enabled)
    return;
  Json line{{"event", event}, {"t", since_start.seconds()}};
  line.update(fields);
  // Paths may hold any bytes; numbers that are not finite become null.
  progress_text(line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void send_error(const std::string& text, int exit_code) {
  send_event("message", {{"level", "error"}, {"text", text}, {"exit_code", exit_code}});
}

void send_end(int exit_code) {
  send_event("end", {{"exit_code", exit_code}});
}

} // namespace vdbeam::cli
