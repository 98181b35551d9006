#include "vdbeam/deep_image.h"

#include <cstddef>

namespace vdbeam {

std::vector<std::array<float, 4>> DeepImage::flatten() const {
  std::vector<std::array<float, 4>> pixels;
  pixels.reserve(counts.size());
  std::size_t sample = 0;
  for (const std::uint32_t count : counts) {
    double sum[4] = {}, light = 1; // what of the light behind is left
    for (const std::size_t end = sample + count; sample < end; ++sample) {
      const float colour[] = {r[sample], g[sample], b[sample], a[sample]};
      for (int c = 0; c < 4; ++c)
        sum[c] += light * static_cast<double>(colour[c]);
      light *= 1 - static_cast<double>(a[sample]);
    }
    pixels.push_back({static_cast<float>(sum[0]), static_cast<float>(sum[1]),
                      static_cast<float>(sum[2]), static_cast<float>(sum[3])});
  }
  return pixels;
}

} // namespace vdbeam
