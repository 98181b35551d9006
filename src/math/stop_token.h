#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>

namespace vdbeam {

/// Thrown by work that ends early because its StopToken said so, and that leaves no result.
struct Stopped {};

/// Ends long loops on request of the caller or at a time limit. A check
/// reads the clock, so loops whose rounds take less than a microsecond ask now and then.
class StopToken {
public:
  using Clock = std::chrono::steady_clock;

  explicit StopToken(const std::atomic<bool>* request = nullptr) : request_(request) {}

  /// Not while other threads ask.
  void set_deadline(Clock::time_point deadline) { deadline_ = deadline; }
  void set_deadline(Clock::time_point begin, double seconds) {
    constexpr double never = 1e8; // seconds; the clock could not hold infinity
    if (seconds < never)
      set_deadline(begin + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(std::max(0.0, seconds))));
  }

  bool requested() const { return request_ && request_->load(std::memory_order_relaxed); }
  bool time_is_over() const { return deadline_ && Clock::now() >= *deadline_; }
  bool stopped() const { return requested() || time_is_over(); }
  /// Throws Stopped where the loop should end.
  void check() const {
    if (stopped())
      throw Stopped();
  }

private:
  const std::atomic<bool>* request_;
  std::optional<Clock::time_point> deadline_;
};

} // namespace vdbeam
