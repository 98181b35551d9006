#pragma once

#include "batch/batch_origin.h"

#include <optional>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// How a frame of a batch ended.
struct FrameOutcome {
  int frame = 1;
  std::string status;             ///< "done", "skipped", "failed", "interrupted"
  std::string output;             ///< path of its image
  std::string reason;             ///< one line: why it failed or was skipped
  double seconds = 0;             ///< wall clock, from when it was ready
  std::optional<int> exit_code{}; ///< of a failed frame: what it would have been alone
  /// Estimated MRSE of a rendered image with its 95 % interval.
  std::optional<double> error{}, error_low{}, error_high{};
};

/// Result of a batch, without frames that were not begun.
struct BatchSummary {
  std::string scene;
  std::vector<int> frames; ///< all that were asked for
  std::vector<FrameOutcome> outcomes;
  BatchOrigin origin;

  std::vector<int> with_status(const std::string& status) const;
  /// "24 frames: 20 done, 3 skipped, 1 failed", and a line for each failure.
  std::string text() const;
  /// docs/how-to/sequences.md. Throws FrameError.
  void write(const std::string& path) const;
};

/// The summary that a batch wrote to a file. Throws InputError, naming file and key, for anything
/// else.
BatchSummary read_summary(const std::string& path);

/// Where the image of an outcome is: a relative path starts in the folder of the batch or, if the
/// image is not there, in the present one.
std::string image_path(const BatchSummary& summary, const FrameOutcome& outcome);

} // namespace vdbeam::cli
