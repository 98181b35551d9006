#pragma once

#include "vdbeam/render.h"

#include <string>

namespace vdbeam::cli {

/// Values of command-line options about batches; each throws InputError naming its option.

/// "0-63", or "7" for a single pass.
PassRange parse_pass_range(const std::string& text);

/// "x0,y0,x1,y1", each at least 0, the last two beyond the first two.
PixelRegion parse_region(const std::string& text);

/// "300s", "5m": by time; "16": by passes. Path and resuming are left as they are by default.
CheckpointSettings parse_checkpoint(const std::string& text);

/// "2s": by time; "1": by passes.
SnapshotInterval parse_snapshot(const std::string& text);

} // namespace vdbeam::cli
