#pragma once

#include <string>

namespace vdbeam {

/// A job file says who wrote it and holds a checksum of itself, so that `vdbeam farm` can write it
/// anew and yet replaces neither other files nor what somebody has changed by hand.

/// The words that an engine puts in its job file: "Written by vdbeam farm NAME, checksum 0...".
std::string job_mark(const std::string& engine);

/// The text of a job file with its checksum in the mark.
std::string sealed_job(std::string text);

/// Kind of an existing file at the path of a job file.
enum class JobFile { ours, changed, other };
JobFile judge_job(const std::string& text);

} // namespace vdbeam
