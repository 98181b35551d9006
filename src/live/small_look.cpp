#include "live/small_look.h"

#include "render/draft.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Pixels across, and the images that are worth the time.
constexpr int small_width = 120;
constexpr int least_reduction = 3;

/// Interpolates between the middles of the pixels of `small`, whose size is `reduction` times
/// smaller each way.
std::vector<float> enlarged(const std::vector<float>& small, const Image& from, const Image& to) {
  std::vector<float> large(static_cast<std::size_t>(to.width) *
                           static_cast<std::size_t>(to.height));
  struct Place {
    std::size_t low, high;
    float share;
  };
  const auto place = [](int i, int size, int small_size) {
    const double x = std::clamp((i + 0.5) * small_size / size - 0.5, 0.0, small_size - 1.0);
    const auto low = static_cast<std::size_t>(x);
    return Place{low, std::min(low + 1, static_cast<std::size_t>(small_size - 1)),
                 static_cast<float>(x - static_cast<double>(low))};
  };
  const auto width = static_cast<std::size_t>(from.width);
  tbb::parallel_for(0, to.height, [&](int y) {
    const Place row = place(y, to.height, from.height);
    for (int x = 0; x < to.width; ++x) {
      const Place column = place(x, to.width, from.width);
      const auto across = [&](std::size_t j) {
        return small[j * width + column.low] * (1 - column.share) +
               small[j * width + column.high] * column.share;
      };
      large[static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) +
            static_cast<std::size_t>(x)] =
          across(row.low) * (1 - row.share) + across(row.high) * row.share;
    }
  });
  return large;
}

} // namespace

std::optional<Image> take_small_look(const Scene& scene, const PreparedScenePtr& prepared,
                                     const std::atomic<bool>& stop) {
  const int reduction = static_cast<int>(std::lround(
      static_cast<double>(std::max(scene.image.width, scene.image.height)) / small_width));
  if (reduction < least_reduction)
    return std::nullopt;
  Scene small = reduced(scene, reduction);
  small.layers = scene.layers;
  small.render.estimator = EstimatorType::path;
  small.render.passes = 1;
  small.render.time.reset();
  small.render.target_error.reset();
  RenderHooks hooks;
  hooks.stop = &stop;
  const RenderResult result = render(small, prepared, {}, hooks);
  if (stop)
    return std::nullopt;
  Image image = result.image;
  image.width = scene.image.width + 2 * scene.image.overscan;
  image.height = scene.image.height + 2 * scene.image.overscan;
  image.x = image.y = -scene.image.overscan;
  image.full_width = scene.image.overscan > 0 ? scene.image.width : 0;
  image.full_height = scene.image.overscan > 0 ? scene.image.height : 0;
  for (ImageChannel& channel : image.channels)
    channel.data = enlarged(channel.data, result.image, image);
  return image;
}

} // namespace vdbeam
