#include "image/output_formats.h"

#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace vdbeam {
namespace {

constexpr OutputFormat formats[] = {
    {".exr", "OpenEXR, every channel, linear",
     [](const Image& image, const std::string& path, const WriteOptions&) {
       write_exr(image, path);
     }},
    {".png", "8-bit sRGB preview",
     [](const Image& image, const std::string& path, const WriteOptions& options) {
       write_png(image, path, options.exposure, options.view);
     }},
};

} // namespace

std::span<const OutputFormat> output_formats() {
  return formats;
}

const OutputFormat& output_format(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string known;
  for (const OutputFormat& format : formats) {
    if (format.extension == extension)
      return format;
    known += fmt::format("{}{}", known.empty() ? "" : ", ", format.extension);
  }
  throw InputError(
      fmt::format("{}: unknown output format \"{}\"; known are {}", path, extension, known));
}

void write_image(const Image& image, const std::string& path, const WriteOptions& options) {
  output_format(path).write(image, path, options);
}

} // namespace vdbeam
