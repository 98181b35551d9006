#pragma once

#include "farm/farm_job.h"

#include <span>
#include <string>

namespace vdbeam {

/// A queueing system that takes vdbeam's jobs.
struct FarmEngine {
  const char* name;
  const char* description; ///< for --help
  /// The job file's text, a pure function of the job. Throws InputError for what the engine cannot
  /// do.
  std::string (*write)(const FarmJob& job);
  /// The command that submits the job; one line.
  std::string (*how_to_submit)(const FarmJob& job);
};

/// Every engine, in the order of --help. A new one is its file and a line of this table.
std::span<const FarmEngine> farm_engines();

std::string slurm_script(const FarmJob& job);
std::string slurm_submission(const FarmJob& job);
std::string openjd_template(const FarmJob& job);
std::string openjd_submission(const FarmJob& job);

} // namespace vdbeam
