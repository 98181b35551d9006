#include "live/small_look.h"

#include "machine/stopwatch.h"
#include "render/draft.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace vdbeam {
namespace {

/// Time of a look [s], and its fewest and most pixels: fewer show nothing, and drafts have more.
constexpr double look_seconds = 0.08;
constexpr double fewest_pixels = 800, most_pixels = 16000;
/// Looks of more pixels each way are not worth the time.
constexpr int least_reduction = 2;

/// Where the middle of a pixel lies between two pixels of a smaller image.
struct Place {
  std::size_t low, high;
  float share; ///< of the second
};

std::vector<Place> places(int size, int small_size) {
  std::vector<Place> places;
  for (int i = 0; i < size; ++i) {
    const double x = std::clamp((i + 0.5) * small_size / size - 0.5, 0.0, small_size - 1.0);
    const auto low = static_cast<std::size_t>(x);
    places.push_back({low, std::min(low + 1, static_cast<std::size_t>(small_size - 1)),
                      static_cast<float>(x - static_cast<double>(low))});
  }
  return places;
}

/// The image that a small one becomes, without pixels.
Image frame_of(const Image& small, const ImageSettings& settings) {
  Image image = small;
  for (ImageChannel& channel : image.channels)
    channel.data.clear();
  image.width = settings.raster_width();
  image.height = settings.raster_height();
  image.x = image.y = -settings.overscan;
  image.full_width = settings.overscan > 0 ? settings.width : 0;
  image.full_height = settings.overscan > 0 ? settings.height : 0;
  return image;
}

} // namespace

Image enlarged(const Image& small, const ImageSettings& settings) {
  Image image = frame_of(small, settings);
  const std::vector<Place> columns = places(image.width, small.width);
  const std::vector<Place> rows = places(image.height, small.height);
  tbb::parallel_for(std::size_t{0}, small.channels.size(), [&](std::size_t c) {
    std::vector<float>& out = image.channels[c].data;
    out.reserve(columns.size() * rows.size());
    const float* values = small.channels[c].data.data();
    const auto width = static_cast<std::size_t>(small.width);
    std::vector<float> row(width);
    for (const Place& y : rows) {
      for (std::size_t x = 0; x < width; ++x) {
        const float low = values[y.low * width + x], high = values[y.high * width + x];
        row[x] = low + (high - low) * y.share;
      }
      for (const Place& x : columns)
        out.push_back(row[x.low] + (row[x.high] - row[x.low]) * x.share);
    }
  });
  return image;
}

std::optional<Image> SmallLooks::take(const Scene& scene, const PreparedScenePtr& prepared,
                                      const std::atomic<bool>& stop) {
  const double whole = static_cast<double>(scene.image.raster_width()) *
                       static_cast<double>(scene.image.raster_height());
  const int reduction = static_cast<int>(std::ceil(std::sqrt(whole / pixels_)));
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
  hooks.discards_when_stopped = true;
  const Stopwatch watch;
  RenderResult result = render(small, prepared, {}, hooks);
  if (stop)
    return std::nullopt;
  const double rendered = static_cast<double>(result.image.width) * result.image.height;
  pixels_ = std::clamp(rendered * look_seconds / std::max(1e-4, watch.seconds()), fewest_pixels,
                       most_pixels);
  return std::move(result.image);
}

} // namespace vdbeam
