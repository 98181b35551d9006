#include "image/image_readers.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
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
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  char start[4] = {};
  if (!file.read(start, 1))
    throw InputError(path + ": cannot be read: " + (errno ? std::strerror(errno) : "it is empty"));
  file.read(start + 1, sizeof start - 1);
  file.close();
  for (const InputFormat& format : input_formats)
    if (std::string_view(start, sizeof start).substr(0, format.magic.size()) == format.magic)
      return format.read(path);
  throw InputError(path + ": neither an OpenEXR file, nor a Radiance .hdr picture, nor a PNG");
}

} // namespace vdbeam
