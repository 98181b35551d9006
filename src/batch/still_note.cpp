#include "batch/still_note.h"

#include "text/frame_range.h"
#include "text/text.h"

#include <fmt/format.h>

namespace vdbeam::cli {

std::string still_note(const SceneDocument& document, const std::string& scene,
                       const std::vector<int>& frames) {
  if (frames.size() < 2 || document.depends_on_frame())
    return {};
  std::string note = fmt::format("{}: nothing depends on the frame: all {} images will be the same",
                                 scene, frames.size());
  for (const SceneFile& file : document.files()) {
    const std::string pattern = frame_pattern_of(file.pattern);
    if (!pattern.empty() && frames_on_disk(pattern).size() > 1)
      return one_line(
          fmt::format("{}; {} names a single file of the sequence {}", note, file.key, pattern));
  }
  return one_line(note);
}

} // namespace vdbeam::cli
