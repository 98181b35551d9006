#include "image/output_formats.h"

#include "image/color_conversion.h"
#include "image/exr_stream.h"
#include "image/layer_names.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>

#include <filesystem>

namespace vdbeam {
namespace {

constexpr OutputFormat formats[] = {
    {".exr", "OpenEXR, every channel, linear", true,
     [](const Image& image, const std::string& path, const WriteOptions& options) {
       const auto space = image.metadata.find("vdbeam:outputSpace");
       const auto names = image.metadata.find("vdbeam:layerNames");
       const bool passing = options.life == ImageLife::passing;
       if (space == image.metadata.end() && names == image.metadata.end() && !passing)
         return write_exr(image, path, options.links);
       Image converted = image;
       converted.metadata.erase("vdbeam:outputSpace");
       if (space != image.metadata.end())
         convert_to_output_space(converted, space->second);
       if (names != image.metadata.end())
         rename_layers(converted, names->second);
       if (passing)
         converted.metadata["vdbeam:compression"] = "none";
       write_exr(converted, path, options.links, passing ? Synced::no : Synced::yes);
     }},
    {".png", "8-bit sRGB preview", false,
     [](const Image& image, const std::string& path, const WriteOptions& options) {
       write_png(image, path, options.exposure, options.view, options.life);
     }},
};

} // namespace

std::span<const OutputFormat> output_formats() {
  return formats;
}

std::string output_extensions() {
  std::vector<std::string> names;
  for (const OutputFormat& format : formats)
    names.emplace_back(format.extension);
  return join_words(names, "or");
}

const OutputFormat& output_format(const std::string& path) {
  const std::string extension = lower_case(std::filesystem::path(path).extension().string());
  for (const OutputFormat& format : formats)
    if (format.extension == extension)
      return format;
  throw InputError(fmt::format("{}: unknown output format \"{}\"; it must be {}", path, extension,
                               output_extensions()));
}

void write_image(const Image& image, const std::string& path, const WriteOptions& options) {
  output_format(path).write(image, path, options);
}

} // namespace vdbeam
