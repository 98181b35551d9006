#include "page/thumbnail.h"

#include "image/color_conversion.h"
#include "image/output_formats.h"
#include "vdbeam/error.h"
#include "vdbeam/image_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace vdbeam {
namespace {

constexpr int thumbnail_side = 320;

/// A weighted source pixel of a smaller row or column.
struct Tap {
  std::size_t source;
  double weight; ///< the weights of a pixel add up to 1
};

/// The source pixels that lie under each of `small` pixels, when `large` of them shrink to these.
std::vector<std::vector<Tap>> box_filter(int large, int small) {
  std::vector<std::vector<Tap>> taps(static_cast<std::size_t>(small));
  const double scale = static_cast<double>(large) / small;
  for (int i = 0; i < small; ++i) {
    const double begin = i * scale, end = (i + 1) * scale;
    for (int j = static_cast<int>(begin); j < large && j < end; ++j) {
      const double covered = std::min(end, j + 1.0) - std::max(begin, static_cast<double>(j));
      if (covered > 0)
        taps[static_cast<std::size_t>(i)].push_back({static_cast<std::size_t>(j), covered / scale});
    }
  }
  return taps;
}

std::vector<float> shrink(const Image& image, const std::vector<float>& plane, const Image& small) {
  const auto columns = box_filter(image.width, small.width);
  const auto rows = box_filter(image.height, small.height);
  std::vector<float> result;
  result.reserve(rows.size() * columns.size());
  for (const auto& row : rows)
    for (const auto& column : columns) {
      double sum = 0;
      for (const Tap& y : row)
        for (const Tap& x : column) {
          const float value = plane[y.source * static_cast<std::size_t>(image.width) + x.source];
          sum += std::isfinite(value) ? y.weight * x.weight * static_cast<double>(value) : 0;
        }
      result.push_back(static_cast<float>(sum));
    }
  return result;
}

double mean_luminance(const Image& image) {
  constexpr double weights[] = {0.2126, 0.7152, 0.0722}; // ITU-R BT.709
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (const float value : image.channels[c].data)
      sum += weights[c] * static_cast<double>(value);
  return sum / static_cast<double>(image.channels[0].data.size());
}

} // namespace

Image thumbnail_of(const Image& image, int side) {
  const double scale = std::min(
      {1.0, static_cast<double>(side) / image.width, static_cast<double>(side) / image.height});
  Image small;
  small.width = std::max(1, static_cast<int>(std::lround(image.width * scale)));
  small.height = std::max(1, static_cast<int>(std::lround(image.height * scale)));
  small.primaries = image.primaries;
  for (const char* name : {"R", "G", "B"}) {
    const ImageChannel* channel = image.find(name);
    if (!channel)
      throw InputError(fmt::format("the image has no channel {}", name));
    small.channels.push_back({name, shrink(image, channel->data, small)});
  }
  if (small.primaries && !small.primaries->is_near({}))
    convert_colors(small, {});
  return small;
}

ThumbnailFacts make_thumbnail(const std::string& path, const std::string& thumbnail,
                              double exposure, const std::string& view) {
  const Image image = read_image(path);
  const Image small = thumbnail_of(image, thumbnail_side);
  if (output_format(path).complete)
    write_png(small, thumbnail, exposure, view);
  else
    write_png(small, thumbnail, 0, "srgb"); // it has its exposure and view already
  ThumbnailFacts facts;
  facts.width = small.width;
  facts.height = small.height;
  facts.brightness = mean_luminance(small);
  const auto number = [&](const char* name, std::optional<double>& value) {
    if (const auto found = image.numbers.find(name);
        found != image.numbers.end() && std::isfinite(found->second))
      value = found->second;
  };
  number("vdbeam:errorEstimate", facts.error);
  number("vdbeam:errorLow", facts.error_low);
  number("vdbeam:errorHigh", facts.error_high);
  number("vdbeam:seconds", facts.seconds);
  return facts;
}

} // namespace vdbeam
