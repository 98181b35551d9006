#include "render/develop_bands.h"

#include "film/layers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace vdbeam {
namespace {

constexpr int rows_per_band = 32;

/// Rows [y0, y0 + rows_per_band) of the window, or what there is of them.
PixelRegion band_of(const PixelRegion& window, int y0) {
  return {window.x0, y0, window.x1, std::min(y0 + rows_per_band, window.y1)};
}

/// An image like the band's, of the window's size, in which nothing is filled in.
Image make_room(const Image& band, const PixelRegion& window) {
  Image image = band;
  image.height = window.height();
  const std::size_t pixels =
      static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
  // New memory costs as much time as to fill it, so all threads share that.
  tbb::parallel_for(std::size_t{0}, image.channels.size(),
                    [&](std::size_t c) { image.channels[c].data.resize(pixels); });
  return image;
}

} // namespace

Image develop_bands(const PixelRegion& window,
                    const std::function<PassImage(const PixelRegion&)>& image_of,
                    const std::function<Film(int, int)>& film_of,
                    const std::vector<LayerSettings>& layers, std::uint64_t& invalid_values) {
  std::atomic<std::uint64_t> invalid = 0;
  const auto develop = [&](int y0) {
    const PixelRegion band = band_of(window, y0);
    Film film = film_of(band.width(), band.height());
    film.add(image_of(band));
    invalid += film.invalid_values();
    return develop_layers(film, layers);
  };
  const Image first = develop(window.y0);
  Image image = make_room(first, window);
  const auto put = [&](const Image& band, int y0) {
    const auto begin = static_cast<std::ptrdiff_t>(y0 - window.y0) * window.width();
    for (std::size_t c = 0; c < image.channels.size(); ++c)
      std::copy(band.channels[c].data.begin(), band.channels[c].data.end(),
                image.channels[c].data.begin() + begin);
  };
  put(first, window.y0);
  tbb::parallel_for(window.y0 + rows_per_band, window.y1 + rows_per_band - 1, rows_per_band,
                    [&](int y0) {
                      if (y0 < window.y1)
                        put(develop(y0), y0);
                    });
  invalid_values += invalid;
  return image;
}

} // namespace vdbeam
