#pragma once

#include "machine/mapped_file.h"
#include "math/stop_token.h"

#include <cstdint>
#include <functional>
#include <string>

namespace vdbeam {

/// Seconds that reading a file of this size may take on a slow or busy disk, at 10 MB/s.
constexpr double time_for(std::uint64_t file_bytes) {
  return 1e-7 * static_cast<double>(file_bytes);
}

/// Limits of a guarded child process.
struct GuardLimits {
  double seconds = 120;     ///< of wall-clock time; time during which both were suspended is free
  double cpu_seconds = 120; ///< of processor time
  std::uint64_t bytes = 0;  ///< of memory on top of what the parent has, and of output
  const StopToken* stop = nullptr; ///< ends the child and throws Stopped, as StopReading does
};

/// Runs `work(descriptor)` in a forked child process and returns what it wrote to the descriptor (a
/// file in memory). Whatever the work does, crash, hang or ask for endless memory, this process
/// carries on: every failure throws one line that opens with `label`, within the limits. An Error
/// that the work throws arrives as it is, any other exception as a FrameError.
///
/// The child has one thread, and the work must not start or use others: no TBB
/// (research-log/decisions.md says why). It ends without running destructors, also where an
/// exception ends the work.
MappedFile run_guarded(const std::string& label, const GuardLimits& limits,
                       const std::function<void(int)>& work);

} // namespace vdbeam
