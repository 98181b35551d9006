#pragma once

#include "vdbeam/memory_plan.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdbeam {

/// A sequence to render on a farm, as every engine's job file describes it. Paths are absolute.
struct FarmJob {
  std::string name;                 ///< letters, digits, '.', '_' and '-'
  std::string program = "vdbeam";   ///< the program's name or path on the machines of the farm
  std::string folder;               ///< where the command ran; relative paths start there
  std::string job_file;             ///< where the job file goes; empty: standard output
  std::string scene;                ///< scene file or VDB
  std::vector<std::string> options; ///< words that `vdbeam render` gets besides those below
  std::vector<int> frames;          ///< sorted, without doubles
  std::string output;               ///< with a frame number's place where there are several frames
  std::string logs;                 ///< folder of the tasks' logs
  int chunk = 1;                    ///< frames of one task
  int splits = 1;                   ///< parts into which a frame's passes are divided
  int passes = 0;                   ///< of a frame; needed where it is split
  int running = 0;                  ///< most tasks that run at once; 0: no limit
  int threads = 8;                  ///< of one task
  std::uint64_t memory_mib = 1024;  ///< of one task
  std::uint64_t merge_memory_mib = 1024;
  double time_limit = 0;   ///< seconds of one task; 0: the farm's own
  double checkpoint = 300; ///< seconds between checkpoints
};

/// Number of tasks that `frames` make in chunks.
int task_count(const FarmJob& job);

/// The frames whose planned memory stands for all: the first, the middle and the last one, each
/// once, or the first alone where the scene is the same for all frames.
std::vector<int> frames_to_plan(const std::vector<int>& frames, bool frames_differ);

/// The passes of each part: "0-31", "32-63". As even as can be, the larger parts first; a single
/// empty text where the frame is not split. Throws InputError for more parts than passes.
std::vector<std::string> pass_ranges(const FarmJob& job);

/// "smoke.####.exr" of passes "0-31" is "smoke.####.passes_0-31.exr".
std::string partial_path(const std::string& output, const std::string& pass_range);

/// A word of a shell command, in quotes where it needs them.
std::string shell_word(const std::string& text);

/// Seconds as an option's value: "300s", "1.5s".
std::string seconds_text(double seconds);

/// Memory to request for a task of this plan [MiB]: the frame's planned peak, or what it keeps
/// while another one like it is read, whichever is more, and a quarter more.
std::uint64_t task_memory_mib(const MemoryPlan& plan);
/// The same for a merge: the film twice.
std::uint64_t merge_memory_mib(const MemoryPlan& plan);

} // namespace vdbeam
