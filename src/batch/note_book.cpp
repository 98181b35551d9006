#include "batch/note_book.h"

#include "text/frame_range.h"

#include <algorithm>
#include <fmt/format.h>

namespace vdbeam::cli {
namespace {

/// The text without its numbers.
std::string kind_of(const std::string& note) {
  std::string kind;
  for (const char c : note)
    if (c < '0' || c > '9')
      kind += c;
  return kind;
}

} // namespace

bool NoteBook::add(const std::string& note, int frame) {
  const std::string kind = kind_of(note);
  bool first = true;
  for (Entry& entry : entries_) {
    if (entry.kind != kind)
      continue;
    const bool of_this_frame = entry.frames.back() == frame;
    if (of_this_frame && entry.text != note)
      continue; // another volume or grid of the same frame
    if (!of_this_frame)
      entry.frames.push_back(frame);
    first = false;
    break;
  }
  if (first)
    entries_.push_back({kind, note, {frame}});
  return first;
}

std::vector<std::string> NoteBook::repeated() const {
  std::vector<std::string> lines;
  for (const Entry& entry : entries_)
    if (entry.frames.size() > 1) {
      std::vector<int> frames = entry.frames;
      std::sort(frames.begin(), frames.end());
      lines.push_back(
          fmt::format("note, in frames {}: {}", format_frame_range(frames), entry.text));
    }
  return lines;
}

} // namespace vdbeam::cli
