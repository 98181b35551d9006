#include "image/image_readers.h"
#include "image/srgb.h"
#include "machine/input_file.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <png.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbeam {
namespace {

struct FreePng {
  void operator()(png_image* png) const { png_image_free(png); }
};
using PngPtr = std::unique_ptr<png_image, FreePng>;

template <class T>
std::vector<T> read_pixels(png_image& png, png_uint_32 format, const std::string& path) {
  png.format = format;
  std::vector<T> pixels(static_cast<std::size_t>(png.width) * png.height * 4);
  if (!png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr))
    not_readable(path, "PNG", png.message);
  return pixels;
}

} // namespace

Image read_png(const std::string& path) {
  check_input_file(path);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  const PngPtr freed(&png);
  if (!png_image_begin_read_from_file(&png, path.c_str()))
    not_readable(path, "PNG", png.message);
  if (std::int64_t(png.width) * png.height > max_image_pixels)
    not_readable(path, "PNG",
                 fmt::format("its size of {} x {} pixels is outside 1 to 2^28 pixels", png.width,
                             png.height));
  // Deflate packs 1032 to 1 at best, and a byte holds eight pixels where there are two colours.
  check_size_fits_file(path, static_cast<double>(png.width) * png.height / 8, 1032);
  Image image;
  image.width = static_cast<int>(png.width);
  image.height = static_cast<int>(png.height);
  const std::size_t count = static_cast<std::size_t>(png.width) * png.height;
  const std::size_t channels = png.format & PNG_FORMAT_FLAG_ALPHA ? 4 : 3;
  for (std::size_t c = 0; c < channels; ++c)
    image.channels.push_back({std::string(1, "RGBA"[c]), std::vector<float>(count)});
  if (png.format & PNG_FORMAT_FLAG_LINEAR) { // 16 bits; libpng has multiplied them by their alpha
    const auto pixels = read_pixels<std::uint16_t>(png, PNG_FORMAT_LINEAR_RGB_ALPHA, path);
    for (std::size_t i = 0; i < count; ++i) {
      const auto alpha = static_cast<float>(pixels[4 * i + 3]);
      for (std::size_t c = 0; c < 3; ++c)
        image.channels[c].data[i] = alpha > 0 ? static_cast<float>(pixels[4 * i + c]) / alpha : 0;
      if (channels == 4)
        image.channels[3].data[i] = alpha / 65535;
    }
    return image;
  }
  const std::array<float, 256> light = light_of_bytes();
  const auto pixels = read_pixels<unsigned char>(png, PNG_FORMAT_RGBA, path);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < channels; ++c)
      image.channels[c].data[i] =
          c < 3 ? light[pixels[4 * i + c]] : static_cast<float>(pixels[4 * i + c]) / 255;
  return image;
}

} // namespace vdbeam
