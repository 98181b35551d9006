#include "image/color_conversion.h"
#include "image/srgb.h"
#include "image/view_transform.h"
#include "machine/atomic_file.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <fmt/format.h>
#include <png.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbeam {
namespace {

/// Noise in [0, 1) that decides which of two levels a value between them takes, so that a sky has
/// no bands: gradient noise, which eyes see least (Jimenez 2014, "Next generation post processing
/// in Call of Duty: Advanced Warfare"). 1/2 at the first pixel.
double dither(std::size_t x, std::size_t y) {
  // No value is negative here, and to round towards 0 takes less time than std::floor.
  const auto fraction = [](double value) {
    return value - static_cast<double>(static_cast<std::int64_t>(value));
  };
  const double ramp = 0.06711056 * static_cast<double>(x) + 0.00583715 * static_cast<double>(y);
  return fraction(52.9829189 * fraction(ramp) + 0.5);
}

/// The sRGB code of 8 bits: rounded down after `noise` is added. NaN and
/// negative values are black.
unsigned char encode_srgb(double linear, double noise) {
  if (!(linear > 0))
    return 0;
  const auto light = static_cast<float>(std::min(linear, 1.0));
  return static_cast<unsigned char>(srgb_of_light(light) * 255 + static_cast<float>(noise));
}

std::vector<unsigned char> encode_pixels(const Image& image, const std::string& path,
                                         double exposure, const ViewTransform& view) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  const ImageChannel* channels[3];
  const char* const names[] = {"R", "G", "B"};
  for (int c = 0; c < 3; ++c) {
    channels[c] = image.find(names[c]);
    if (!channels[c] || channels[c]->data.size() != pixels || pixels == 0)
      throw FrameError(
          fmt::format("{}: cannot be written: the image has no channel {}", path, names[c]));
  }
  constexpr double brightest = 1e30; // infinity, too, has a colour
  const double scale = std::exp2(exposure);
  std::vector<unsigned char> bytes(pixels * 3);
  const auto width = static_cast<std::size_t>(image.width);
  tbb::parallel_for(std::size_t{0}, pixels / width, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x;
      Vec3d radiance;
      for (int c = 0; c < 3; ++c) {
        const double value = static_cast<double>(channels[c]->data[i]) * scale;
        radiance[c] = value > 0 ? std::min(value, brightest) : 0;
      }
      const Vec3d shown = view.apply(radiance);
      const double noise = dither(x, y);
      for (int c = 0; c < 3; ++c)
        bytes[3 * i + static_cast<std::size_t>(c)] = encode_srgb(shown[c], noise);
    }
  });
  return bytes;
}

} // namespace

void write_png(const Image& picture, const std::string& path, double exposure,
               const std::string& view, ImageLife life) {
  Image shown;
  if (picture.primaries && !picture.primaries->is_near({})) {
    shown = picture;
    convert_colors(shown, {}); // to those of a screen
  }
  const Image& image = shown.channels.empty() ? picture : shown;
  const std::vector<unsigned char> pixels =
      encode_pixels(image, path, exposure, view_transform(view));
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  const bool passing = life == ImageLife::passing;
  if (passing)
    png.flags = PNG_IMAGE_FLAG_FAST;
  // To ask for the exact size would compress the pixels twice.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<unsigned char> encoded(size);
  if (png_image_write_to_memory(&png, encoded.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw FrameError(fmt::format("{}: cannot be written: {}", path, png.message));
  AtomicFile file(path);
  file.write(encoded.data(), size);
  file.commit(passing ? Synced::no : Synced::yes);
}

} // namespace vdbeam
