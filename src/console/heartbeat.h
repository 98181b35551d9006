#pragma once

#include <chrono>
#include <string>

namespace vdbeam::cli {

/// The longest silence of a log that nobody looks at: queues end silent processes.
inline constexpr std::chrono::seconds heartbeat_interval{10};

/// Repeats a line in the log for as long as it lives, whatever the program is doing meanwhile, by
/// SIGALRM. One at a time.
class Heartbeat {
public:
  explicit Heartbeat(const std::string& line);
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  ~Heartbeat();

  /// The line from now on.
  void set(const std::string& line);
  /// Another line was logged: the next silence is counted from now.
  void begin_anew();
};

} // namespace vdbeam::cli
