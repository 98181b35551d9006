#include "render/quick_look.h"

#include "estimators/path/path.h"
#include "math/pass_numbers.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace vdbeam {
namespace {

constexpr int coarsest_spacing = 64;

void copy_pixel(const PassImage& from, std::size_t source, PassImage& to, std::size_t target) {
  to.direct[target] = from.direct[source];
  to.indirect[target] = from.indirect[source];
  to.background[target] = from.background[source];
  if (!to.emission.empty())
    to.emission[target] = from.emission[source];
  to.opacity[target] = from.opacity[source];
  to.depth[target] = from.depth[source];
}

/// Which pixels of the window have a value.
class KnownPixels {
public:
  KnownPixels(const PixelRegion& window, const PassImage& image)
      : window_(window), known_(static_cast<std::size_t>(window.width()) * window.height()) {
    for (int y = window.y0; y < window.y1; ++y)
      for (int x = window.x0; x < window.x1; ++x)
        known_[index(x, y)] = image.finished_tiles[image.tile_of(x, y)];
  }

  bool holds(int x, int y) const { return known_[index(x, y)] != 0; }
  void add(int x, int y) { known_[index(x, y)] = 1; }

private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - window_.y0) * static_cast<std::size_t>(window_.width()) +
           static_cast<std::size_t>(x - window_.x0);
  }

  PixelRegion window_;
  std::vector<std::uint8_t> known_;
};

/// Pixels of the grid of this spacing that have no value yet.
std::vector<std::size_t> missing_pixels(const PixelRegion& window, int spacing, int width,
                                        const KnownPixels& known) {
  std::vector<std::size_t> pixels;
  for (int y = window.y0; y < window.y1; y += spacing)
    for (int x = window.x0; x < window.x1; x += spacing)
      if (!known.holds(x, y))
        pixels.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x));
  return pixels;
}

/// The nearest pixel of the finest grid on which there is one with a value.
void fill_from_neighbours(const PixelRegion& window, int finest, const KnownPixels& known,
                          PassImage& image) {
  const auto anchor = [](int x, int begin, int end, int spacing) {
    const int nearest = begin + (x - begin + spacing / 2) / spacing * spacing;
    return nearest < end ? nearest : nearest - spacing;
  };
  const auto fill_row = [&](int y) {
    for (int x = window.x0; x < window.x1; ++x) {
      if (known.holds(x, y))
        continue;
      for (int spacing = finest; spacing <= coarsest_spacing; spacing *= 2) {
        const int from_x = anchor(x, window.x0, window.x1, spacing);
        const int from_y = anchor(y, window.y0, window.y1, spacing);
        if (!known.holds(from_x, from_y))
          continue;
        const auto width = static_cast<std::size_t>(image.width);
        copy_pixel(image, static_cast<std::size_t>(from_y) * width + from_x, image,
                   static_cast<std::size_t>(y) * width + x);
        break;
      }
    }
  };
  tbb::parallel_for(window.y0, window.y1, fill_row);
}

} // namespace

void fill_with_quick_look(const EstimatorInput& input, PassImage& image) {
  const Camera& camera = input.camera;
  if (image.width != camera.width() || image.height != camera.height())
    image.resize(camera.width(), camera.height(), !input.world.medium.emitters.empty());
  KnownPixels known(input.window, image);
  const PathEstimator path(input);
  int spacing = coarsest_spacing;
  for (; spacing >= 1 && !input.stopped(); spacing /= 2) {
    const std::vector<std::size_t> pixels =
        missing_pixels(input.window, spacing, image.width, known);
    PassImage values;
    std::vector<std::uint8_t> finished;
    RenderStatistics uncounted;
    path.render_pixels(quick_look_pass, pixels, values, finished, uncounted);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (!finished[i])
        continue;
      copy_pixel(values, i, image, pixels[i]);
      const auto width = static_cast<std::size_t>(image.width);
      known.add(static_cast<int>(pixels[i] % width), static_cast<int>(pixels[i] / width));
    }
  }
  fill_from_neighbours(input.window, std::max(1, spacing), known, image);
}

} // namespace vdbeam
