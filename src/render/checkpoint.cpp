#include "render/checkpoint.h"

#include "text/frame_range.h"
#include "text/text.h"

#include <fmt/format.h>

#include <numeric>

namespace vdbeam {

std::string why_not_resumable(const FilmFileInfo& info, const FilmFileInfo& own,
                              const PassRange& passes) {
  if (info.frame != own.frame)
    return fmt::format("is a checkpoint of frame {}, not {}", info.frame, own.frame);
  if (info.header.full_width != own.header.full_width ||
      info.header.full_height != own.header.full_height)
    return fmt::format("is a checkpoint of {}x{} pixels, not {}x{}", info.header.full_width,
                       info.header.full_height, own.header.full_width, own.header.full_height);
  if (info.arithmetic != own.arithmetic)
    return "is a checkpoint of a machine that rounds differently (one of the two lacks fused "
           "multiply-add or has another C library)";
  if (info.pass_hash != own.pass_hash)
    return "is a checkpoint of another scene, or of other settings than these";
  if (!info.joins(own))
    return "is a checkpoint of another region";
  std::vector<int> expected(info.passes.size());
  std::iota(expected.begin(), expected.end(), passes.first);
  if (info.passes != expected)
    return fmt::format("holds the passes {}, but this render begins with pass {}",
                       format_frame_range(info.passes), passes.first);
  if (info.passes.back() > passes.last)
    return fmt::format("holds {}, more than the {} asked for",
                       count_text(info.passes.size(), "pass"), passes.last - passes.first + 1);
  return "";
}

} // namespace vdbeam
