#include "image/image_readers.h"
#include "image/picture_guard.h"
#include "machine/input_file.h"
#include "text/printable.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <filesystem>
#include <fmt/format.h>
#include <string_view>

namespace vdbeam {
namespace {

/// One line per format that can be read; files are recognised by their first bytes.
struct InputFormat {
  std::string_view magic;
  Image (*read)(const std::string& path);
};
constexpr InputFormat input_formats[] = {
    {"\x76\x2f\x31\x01", read_exr},
    {"#?", read_hdr},
    {"\x89PNG", read_png},
    {"\xff\xd8\xff", read_jpeg},
};

} // namespace

void not_readable(const std::string& path, const char* kind, const std::string& reason) {
  throw InputError(fmt::format("{}: not a readable {}: {}", path, kind, printable_line(reason)));
}

void check_size_fits_file(const std::string& path, double bytes, double most_per_byte) {
  const auto size = static_cast<double>(std::filesystem::file_size(path));
  // Small files may do without a pixel, for instance where a header says what all of them are.
  constexpr double negligible = 1 << 20;
  if (bytes > negligible && bytes > most_per_byte * size)
    throw InputError(fmt::format("{}: is damaged: {:.0f} bytes cannot hold the {:.0f} MB of pixels "
                                 "that its header announces",
                                 path, size, bytes * 1e-6));
}

Image read_image(const std::string& path) {
  const std::string start = read_start(path, 4);
  if (start.empty())
    throw InputError(path + ": is empty (0 bytes)");
  for (const InputFormat& format : input_formats)
    if (start.starts_with(format.magic))
      return read_guarded_picture(path, format.read);
  throw InputError(path + ": neither an OpenEXR file, nor a Radiance .hdr image, a PNG or a JPEG");
}

} // namespace vdbeam
