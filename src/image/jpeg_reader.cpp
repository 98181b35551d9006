#include "image/image_readers.h"
#include "image/srgb.h"
#include "machine/input_file.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vdbeam {
namespace {

struct FreeDecoder {
  void operator()(void* decoder) const { tjDestroy(decoder); }
};
using Decoder = std::unique_ptr<void, FreeDecoder>;

} // namespace

Image read_jpeg(const std::string& path) {
  const std::uint64_t bytes = check_input_file(path);
  const std::string file = read_text(path, bytes);
  const auto* start = reinterpret_cast<const unsigned char*>(file.data());
  const Decoder decoder(tjInitDecompress());
  if (!decoder)
    throw FrameError("there is no memory for a JPEG decoder");
  int width = 0, height = 0, sampling = 0, space = 0;
  if (tjDecompressHeader3(decoder.get(), start, file.size(), &width, &height, &sampling, &space))
    not_readable(path, "JPEG", tjGetErrorStr2(decoder.get()));
  if (space == TJCS_CMYK || space == TJCS_YCCK)
    not_readable(path, "JPEG", "it is in CMYK; save it in RGB");
  if (std::int64_t{width} * height > max_image_pixels)
    not_readable(path, "JPEG",
                 fmt::format("its size of {} x {} pixels is above 2^28 pixels", width, height));
  // A block of 16 x 16 pixels needs six codes of a bit each.
  check_size_fits_file(path, static_cast<double>(width) * height, 512);
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<unsigned char> pixels(3 * count);
  // A warning, as of a file that ends early, is an error, too: half of such an image is grey.
  if (tjDecompress2(decoder.get(), start, file.size(), pixels.data(), width, 0, height, TJPF_RGB,
                    TJFLAG_ACCURATEDCT))
    not_readable(path, "JPEG", tjGetErrorStr2(decoder.get()));
  Image image;
  image.width = width;
  image.height = height;
  const std::array<float, 256> light = light_of_bytes();
  for (std::size_t c = 0; c < 3; ++c) {
    image.channels.push_back({std::string(1, "RGB"[c]), std::vector<float>(count)});
    for (std::size_t i = 0; i < count; ++i)
      image.channels[c].data[i] = light[pixels[3 * i + c]];
  }
  return image;
}

} // namespace vdbeam
