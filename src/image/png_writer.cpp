#include "machine/atomic_file.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbeam {
namespace {

/// The sRGB encoding of IEC 61966-2-1, to 8 bits. NaN and negative values are black.
unsigned char encode_srgb(double linear) {
  if (!(linear > 0))
    return 0;
  const double value = std::min(linear, 1.0);
  const double encoded =
      value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<unsigned char>(std::lround(encoded * 255));
}

std::vector<unsigned char> encode_pixels(const Image& image, const std::string& path,
                                         double exposure) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  const double scale = std::exp2(exposure);
  std::vector<unsigned char> bytes(pixels * 3);
  const char* const names[] = {"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const ImageChannel* channel = image.find(names[c]);
    if (!channel || channel->data.size() != pixels || pixels == 0)
      throw FrameError(
          fmt::format("{}: cannot be written: the image has no channel {}", path, names[c]));
    for (std::size_t i = 0; i < pixels; ++i)
      bytes[3 * i + c] = encode_srgb(channel->data[i] * scale);
  }
  return bytes;
}

} // namespace

void write_png(const Image& image, const std::string& path, double exposure) {
  const std::vector<unsigned char> pixels = encode_pixels(image, path, exposure);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::vector<unsigned char> encoded;
  bool good = png_image_write_get_memory_size(png, size, 0, pixels.data(), 0, nullptr) != 0;
  if (good) {
    encoded.resize(size);
    good =
        png_image_write_to_memory(&png, encoded.data(), &size, 0, pixels.data(), 0, nullptr) != 0;
  }
  if (!good)
    throw FrameError(fmt::format("{}: cannot be written: {}", path, png.message));
  AtomicFile file(path);
  file.write(encoded.data(), size);
  file.commit();
}

} // namespace vdbeam
