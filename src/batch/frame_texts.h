#pragma once

#include "vdbeam/render.h"

#include <string>

namespace vdbeam::cli {

/// Lines of the log about a frame.

/// What begins: "cloud.toml, auto, 640x360".
std::string start_text(const Scene& scene);
/// "3 passes".
std::string passes_text(int passes);
/// Describes the finished frame: passes, time, errors, memory, optical depth, opacity and
/// brightness.
std::string end_text(const RenderResult& result, const std::string& output);
/// The interrupted frame. `snapshot` is the path of the quick look; empty: there is none.
std::string stop_text(const RenderResult& result, const std::string& checkpoint,
                      const std::string& snapshot);

} // namespace vdbeam::cli
