#include "farm/openjd_range.h"

#include <cstddef>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// One past the last frame of the arithmetic progression that begins at `begin`.
std::size_t progression_end(const std::vector<int>& frames, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < frames.size() &&
         (end == begin + 1 || frames[end] - frames[end - 1] == frames[begin + 1] - frames[begin]))
    ++end;
  return end;
}

} // namespace

std::string openjd_range(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t i = 0; i < frames.size();) {
    const std::size_t end = progression_end(frames, i);
    // Another step's range must not begin inside of this one, so a short one stays a frame.
    const bool range = end - i >= 3;
    const std::size_t next = range ? end : i + 1;
    text += text.empty() ? "" : ",";
    text += std::to_string(frames[i]);
    if (range) {
      const int step = frames[i + 1] - frames[i];
      text += fmt::format("-{}{}", frames[end - 1], step == 1 ? "" : fmt::format(":{}", step));
    }
    i = next;
  }
  return text;
}

} // namespace vdbeam
