#pragma once

#include "math/stop_token.h"

namespace vdbeam {

/// As long as one of these is there, what this thread reads and makes of files ends where the token
/// says so, by Stopped. Files are read at the bottom of many calls, by guarded processes, decoders
/// and Embree; so none of them can be forgotten, the token is the thread's own.
class StopReading {
public:
  /// The token must outlive this. Of several the last one counts.
  explicit StopReading(const StopToken& stop);
  ~StopReading();
  StopReading(const StopReading&) = delete;
  StopReading& operator=(const StopReading&) = delete;

  /// This thread's token; null: nothing ends its reading.
  static const StopToken* token();
  /// Throws Stopped where reading should end; for between the steps of long work.
  static void check();

private:
  const StopToken* before_;
};

} // namespace vdbeam
