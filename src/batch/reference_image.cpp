#include "batch/reference_image.h"

#include "image/color_conversion.h"
#include "machine/stop_reading.h"
#include "text/frame_range.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>

namespace vdbeam::cli {

std::optional<Image> read_reference(const char* option, const std::string& path,
                                    const ImageSettings& size) {
  if (path.empty())
    return std::nullopt;
  if (size.overscan > 0)
    throw InputError(fmt::format("{}: excludes image.overscan", option));
  Image reference = read_image(path);
  if (reference.width != size.width || reference.height != size.height)
    throw InputError(fmt::format("{} {}: is {}x{}, but the image is {}x{}; use --resolution {}x{}",
                                 option, path, reference.width, reference.height, size.width,
                                 size.height, reference.width, reference.height));
  for (const char* channel : {"R", "G", "B"})
    if (!reference.find(channel))
      throw InputError(fmt::format("{} {}: has no channel {}", option, path, channel));
  std::erase_if(reference.channels, [](const ImageChannel& channel) {
    return channel.name != "R" && channel.name != "G" && channel.name != "B";
  });
  convert_colors(reference, chromaticities_of(size.working_space));
  return reference;
}

std::optional<References> read_references(const FrameFiles& files, int frame,
                                          const ImageSettings& size, const StopToken& stop) {
  const StopReading reading(stop);
  const auto read = [&](const char* option, const std::string& path) {
    return read_reference(option, substitute_frame(path, frame), size);
  };
  try {
    return References{read("--reference", files.reference),
                      read("--second-reference", files.second_reference)};
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

} // namespace vdbeam::cli
