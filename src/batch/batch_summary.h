#pragma once

#include <string>
#include <vector>

namespace vdbeam::cli {

/// How a frame of a batch ended.
struct FrameOutcome {
  int frame = 1;
  std::string status; ///< "done", "skipped", "failed", "interrupted"
  std::string output; ///< path of its image
  std::string reason; ///< one line: why it failed or was skipped
  double seconds = 0; ///< wall clock, from when it was ready
};

/// Result of a batch, without frames that were not begun.
struct BatchSummary {
  std::string scene;
  std::vector<int> frames; ///< all that were asked for
  std::vector<FrameOutcome> outcomes;

  std::vector<int> with_status(const std::string& status) const;
  /// "24 frames: 20 done, 3 skipped, 1 failed", and a line for each failure.
  std::string text() const;
  /// docs/how-to/sequences.md. Throws FrameError.
  void write(const std::string& path) const;
};

} // namespace vdbeam::cli
