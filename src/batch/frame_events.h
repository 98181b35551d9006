#pragma once

#include "batch/batch_summary.h"
#include "batch/failure.h"
#include "report/frame_files.h"
#include "vdbeam/render.h"

#include <string>

namespace vdbeam::cli {

/// The events of a frame for `--progress json` (docs/reference/progress.md). None is sent where
/// events are off.

/// Work of the frame begins. `limits`: the stop rule of the passes asked for.
void send_frame(const Scene& scene, const RenderSettings& limits, const std::string& output,
                std::size_t index);
/// The frame's files are read now.
void send_reading(int frame);
void send_step(int frame, RenderStep step, int pass);
void send_pass(int frame, const PassRecord& record, const RenderStatistics& statistics,
               const RenderSettings& limits);
void send_frame_error(int frame, const Failure& failure);
void send_note(int frame, const std::string& text);
/// A file was written; `result` has its image.
void send_file(Output kind, const std::string& path, int frame, const RenderResult& result);
void send_frame_end(const FrameOutcome& outcome);

} // namespace vdbeam::cli
