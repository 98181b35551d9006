#pragma once

#include "report/frame_files.h"

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// Refuses a path that could not be written, before any work is done: the folder must exist and be
/// writable, the name must not be a folder's nor too long, and several frames need a frame number's
/// place in it. `option` names it in messages ("-o"). Throws InputError with the remedy.
void check_output_path(const std::string& option, const std::string& path,
                       const std::vector<int>& frames);

/// The same for all outputs of a render, and for the names that its side files will have.
void check_output_paths(const FrameFiles& files, const std::vector<int>& frames);

/// "-" for an output that is text: the standard output, which needs no such check.
bool is_stdout(const std::string& path);

/// Writes JSON to a file or, for "-", to the standard output. Throws FrameError.
void write_json_output(const nlohmann::ordered_json& json, const std::string& path);

} // namespace vdbeam::cli
