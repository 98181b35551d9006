#include "report/frame_files.h"

#include "text/frame_range.h"

#include <filesystem>

namespace vdbeam {
namespace {

constexpr OutputKind kinds[] = {
    {Output::image, "-o", &FrameFiles::output},
    {Output::deep, "the deep image of -o", &FrameFiles::output, "deep"},
    {Output::checkpoint, "the checkpoint of -o", &FrameFiles::output, "checkpoint"},
    {Output::snapshot, "the snapshot of -o", &FrameFiles::output, "snapshot"},
    {Output::preview, "--preview", &FrameFiles::preview},
    {Output::report, "--report", &FrameFiles::report, "", true},
    {Output::summary, "--summary", &FrameFiles::summary, "", true, true},
    {Output::page, "--html", &FrameFiles::html, "", false, true, "index.html"},
    {Output::thumbnail, "the thumbnails of --html", &FrameFiles::html, "", false, false,
     "frame.####.png"},
};

} // namespace

std::string OutputKind::pattern(const FrameFiles& files) const {
  const std::string& given = files.*option;
  if (given.empty())
    return given;
  if (*in_folder != '\0')
    return (std::filesystem::path(given) / in_folder).string();
  if (!is_side_file())
    return given;
  return std::filesystem::path(given).replace_extension(std::string(side) + ".exr").string();
}

std::span<const OutputKind> output_kinds() {
  return kinds;
}

std::string output_path(const FrameFiles& files, Output output, int frame) {
  const OutputKind& kind = kinds[static_cast<std::size_t>(output)];
  return substitute_frame(kind.pattern(files), frame);
}

} // namespace vdbeam
