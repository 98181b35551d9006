#pragma once

#include <atomic>
#include <chrono>
#include <optional>

namespace vdbeam {

/// Tells long loops when to end: when the caller asks for it, or when a time limit is over. Asking
/// costs a look at the clock, so loops whose rounds take less than a microsecond ask now and then.
class StopToken {
public:
  using Clock = std::chrono::steady_clock;

  explicit StopToken(const std::atomic<bool>* request = nullptr) : request_(request) {}

  /// Not while other threads ask.
  void set_deadline(Clock::time_point deadline) { deadline_ = deadline; }

  bool requested() const { return request_ && request_->load(std::memory_order_relaxed); }
  bool time_is_over() const { return deadline_ && Clock::now() >= *deadline_; }
  bool stopped() const { return requested() || time_is_over(); }

private:
  const std::atomic<bool>* request_;
  std::optional<Clock::time_point> deadline_;
};

} // namespace vdbeam
