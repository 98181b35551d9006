#include "farm/farm_job.h"

#include "vdbeam/error.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace vdbeam {
namespace {

constexpr std::uint64_t mib = 1024 * 1024;
/// Code, libraries, threads' stacks and what the allocator keeps, of a merge.
constexpr std::uint64_t program_bytes = 300 * mib;

/// A quarter more, up to the next multiple of 64 MiB.
std::uint64_t with_margin(std::uint64_t bytes) {
  constexpr std::uint64_t step = 64 * mib;
  return (bytes + bytes / 4 + step - 1) / step * 64;
}

} // namespace

int task_count(const FarmJob& job) {
  const int frames = static_cast<int>(job.frames.size());
  return (frames + job.chunk - 1) / job.chunk;
}

std::vector<int> frames_to_plan(const std::vector<int>& frames, bool frames_differ) {
  std::vector<int> planned{frames.front()};
  if (!frames_differ)
    return planned;
  for (const int frame : {frames[frames.size() / 2], frames.back()})
    if (std::find(planned.begin(), planned.end(), frame) == planned.end())
      planned.push_back(frame);
  return planned;
}

std::vector<std::string> pass_ranges(const FarmJob& job) {
  if (job.splits <= 1)
    return {""};
  if (job.passes < job.splits)
    throw InputError(
        fmt::format("--splits {}: a frame has only {} passes; use at most one part per pass",
                    job.splits, job.passes));
  std::vector<std::string> ranges;
  int first = 0;
  for (int part = 0; part < job.splits; ++part) {
    const int count = job.passes / job.splits + (part < job.passes % job.splits ? 1 : 0);
    ranges.push_back(fmt::format("{}-{}", first, first + count - 1));
    first += count;
  }
  return ranges;
}

std::string partial_path(const std::string& output, const std::string& pass_range) {
  if (pass_range.empty())
    return output;
  std::filesystem::path path(output);
  const std::string extension = path.extension().string();
  path.replace_filename(path.stem().string() + ".passes_" + pass_range + extension);
  return path.string();
}

std::string shell_word(const std::string& text) {
  const char* const plain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,:=+@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos)
    return text;
  std::string word = "'";
  for (const char c : text)
    word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string seconds_text(double seconds) {
  return fmt::format("{:g}s", seconds);
}

std::uint64_t task_memory_mib(const MemoryPlan& plan) {
  return with_margin(plan.peak_reading_ahead());
}

std::uint64_t merge_memory_mib(const MemoryPlan& plan) {
  return with_margin(program_bytes + 2 * plan.film);
}

} // namespace vdbeam
