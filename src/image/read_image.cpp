#include "image/image_readers.h"
#include "machine/input_file.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <string_view>

namespace vdbeam {
namespace {

/// One line per format that can be read; files are told apart by how they begin.
struct InputFormat {
  std::string_view magic;
  Image (*read)(const std::string& path);
};
constexpr InputFormat input_formats[] = {
    {"\x76\x2f\x31\x01", read_exr},
    {"#?", read_hdr},
    {"\x89PNG", read_png},
};

} // namespace

Image read_image(const std::string& path) {
  const std::string start = read_start(path, 4);
  if (start.empty())
    throw InputError(path + ": is empty (0 bytes)");
  for (const InputFormat& format : input_formats)
    if (start.starts_with(format.magic))
      return format.read(path);
  throw InputError(path + ": neither an OpenEXR file, nor a Radiance .hdr picture, nor a PNG");
}

} // namespace vdbeam
