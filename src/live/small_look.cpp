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

/// Interpolates between the middles of the pixels of `small`, to the size of `to`.
void enlarge(const Image& small, Image& to) {
  const std::vector<Place> columns = places(to.width, small.width);
  const std::vector<Place> rows = places(to.height, small.height);
  for (ImageChannel& channel : to.channels)
    channel.data.resize(columns.size() * rows.size());
  tbb::parallel_for(std::size_t{0}, rows.size() * to.channels.size(), [&](std::size_t task) {
    const std::size_t c = task / rows.size(), y = task % rows.size();
    const auto width = static_cast<std::size_t>(small.width);
    const float* upper = small.channels[c].data.data() + rows[y].low * width;
    const float* lower = small.channels[c].data.data() + rows[y].high * width;
    std::vector<float> row(width);
    for (std::size_t x = 0; x < width; ++x)
      row[x] = upper[x] + (lower[x] - upper[x]) * rows[y].share;
    float* out = to.channels[c].data.data() + y * columns.size();
    for (std::size_t x = 0; x < columns.size(); ++x)
      out[x] =
          row[columns[x].low] + (row[columns[x].high] - row[columns[x].low]) * columns[x].share;
  });
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
  const RenderResult result = render(small, prepared, {}, hooks);
  if (stop)
    return std::nullopt;
  const double rendered = static_cast<double>(result.image.width) * result.image.height;
  pixels_ = std::clamp(rendered * look_seconds / std::max(1e-4, watch.seconds()), fewest_pixels,
                       most_pixels);
  Image image = frame_of(result.image, scene.image);
  enlarge(result.image, image);
  return image;
}

} // namespace vdbeam
