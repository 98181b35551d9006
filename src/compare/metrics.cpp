#include "vdbeam/metrics.h"

#include "compare/flip.h"
#include "errors/history_means.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdbeam {
namespace {

/// Noise of the mean of two references (as MRSE) above which pixels are weighted by a local mean.
constexpr double noise_that_weighs = 0.003;
constexpr double worst_fraction = 0.001; ///< of the pixels, left out of relMSE

using Planes = std::array<const float*, 3>;

Planes rgb_planes(const Image& image, const char* which) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  const char* const names[] = {"R", "G", "B"};
  Planes planes{};
  for (std::size_t c = 0; c < 3; ++c) {
    const ImageChannel* channel = image.find(names[c]);
    if (!channel || channel->data.size() != pixels || pixels == 0)
      throw InputError(
          fmt::format("the {} has no channel {}; R, G and B are compared", which, names[c]));
    planes[c] = channel->data.data();
  }
  return planes;
}

void check_sizes(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw InputError(
        fmt::format("the image is {} x {} pixels, its reference {} x {}; the sizes must "
                    "be equal",
                    image.width, image.height, reference.width, reference.height));
}

/// Mean over the pixels but the worst ones. The sum is in pixel order, so it is reproducible.
double trimmed_mean(const std::vector<double>& errors) {
  const std::size_t dropped =
      static_cast<std::size_t>(worst_fraction * static_cast<double>(errors.size()));
  const std::size_t kept = errors.size() - dropped;
  std::vector<double> sorted = errors;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(kept - 1),
                   sorted.end());
  const double threshold = sorted[kept - 1];
  double sum = 0;
  std::size_t below = 0;
  for (const double error : errors)
    if (error < threshold) {
      sum += error;
      ++below;
    }
  return (sum + static_cast<double>(kept - below) * threshold) / static_cast<double>(kept);
}

/// Mean over the 5 x 5 pixels around each; the border repeats.
std::vector<double> box_mean(const std::vector<double>& plane, int width, int height) {
  std::vector<double> result(plane.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
          sum += plane[static_cast<std::size_t>(std::clamp(y + dy, 0, height - 1)) * width +
                       static_cast<std::size_t>(std::clamp(x + dx, 0, width - 1))];
      result[static_cast<std::size_t>(y) * width + x] = sum / 25;
    }
  return result;
}

/// Standard error of the mean of a plane: its blocks are wide enough to be nearly independent where
/// neighbouring pixels are not.
double standard_error(const std::vector<double>& plane, int width, int height) {
  constexpr int block = 4;
  const double pixels = static_cast<double>(plane.size());
  const double mean = std::accumulate(plane.begin(), plane.end(), 0.0) / pixels;
  double squares = 0;
  for (int y0 = 0; y0 < height; y0 += block)
    for (int x0 = 0; x0 < width; x0 += block) {
      double deviation = 0;
      for (int y = y0; y < std::min(y0 + block, height); ++y)
        for (int x = x0; x < std::min(x0 + block, width); ++x)
          deviation += plane[static_cast<std::size_t>(y) * width + x] - mean;
      squares += deviation * deviation;
    }
  return std::sqrt(squares) / pixels;
}

/// v / r - 1, where both may be 0.
double relative_difference(double value, double reference) {
  return value == reference ? 0 : value / reference - 1;
}

} // namespace

ImageError image_error(const Image& image, const Image& reference) {
  check_sizes(image, reference);
  const Planes v = rgb_planes(image, "image"), r = rgb_planes(reference, "reference");
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  std::vector<double> relative(pixels);
  double squares = 0, mrse = 0, sum_v = 0, sum_r = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    double pixel = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = v[c][i], truth = r[c][i];
      const double square = (value - truth) * (value - truth);
      squares += square;
      mrse += square / ((truth + mrse_offset) * (truth + mrse_offset));
      pixel += square / (truth * truth + mrse_offset);
      sum_v += value;
      sum_r += truth;
    }
    // NaN does not sort; it is as bad as infinity.
    relative[i] = std::isnan(pixel) ? std::numeric_limits<double>::infinity() : pixel / 3;
  }
  const double count = 3 * static_cast<double>(pixels);
  ImageError error;
  error.rmse = std::sqrt(squares / count);
  error.mrse = mrse / count;
  error.relmse = trimmed_mean(relative);
  error.bias = relative_difference(sum_v, sum_r);
  return error;
}

double temporal_error(const Image& before, const Image& after, const Image& reference_before,
                      const Image& reference_after) {
  check_sizes(after, reference_after);
  check_sizes(before, reference_before);
  if (before.width != after.width || before.height != after.height)
    throw InputError(fmt::format("a frame is {} x {} pixels, the next {} x {}; the sizes must be "
                                 "equal",
                                 before.width, before.height, after.width, after.height));
  const Planes v0 = rgb_planes(before, "image"), v1 = rgb_planes(after, "image");
  const Planes r0 = rgb_planes(reference_before, "reference"),
               r1 = rgb_planes(reference_after, "reference");
  const std::size_t pixels = static_cast<std::size_t>(before.width) * before.height;
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const double change = static_cast<double>(v1[c][i]) - v0[c][i];
      const double truth = static_cast<double>(r1[c][i]) - r0[c][i];
      const double error =
          (change - truth) / ((static_cast<double>(r0[c][i]) + r1[c][i]) / 2 + mrse_offset);
      sum += error * error;
    }
  return sum / (3 * static_cast<double>(pixels));
}

ImageError image_error(const Image& image, const Image& a, const Image& b) {
  check_sizes(image, a);
  check_sizes(image, b);
  const Planes v = rgb_planes(image, "image"), first = rgb_planes(a, "first reference"),
               second = rgb_planes(b, "second reference");
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  const double count = 3 * static_cast<double>(pixels);
  std::array<std::vector<double>, 3> truth;
  double noise = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const double x = first[c][i], y = second[c][i], mean = (x + y) / 2;
      truth[c].push_back(mean);
      noise += (x - y) * (x - y) / 4 / ((mean + mrse_offset) * (mean + mrse_offset)) / count;
    }
  if (noise > noise_that_weighs)
    for (std::vector<double>& plane : truth)
      plane = box_mean(plane, image.width, image.height);
  ImageError error;
  double squares = 0, sum_v = 0, sum_m = 0;
  std::vector<double> relative(pixels);
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < pixels; ++i) {
      const double value = v[c][i], m = truth[c][i];
      const double product = (value - first[c][i]) * (value - second[c][i]);
      squares += product / count;
      relative[i] += product / ((m + mrse_offset) * (m + mrse_offset)) / 3;
      error.relmse += product / (m * m + mrse_offset) / count;
      sum_v += value;
      sum_m += m;
    }
  error.mrse = std::accumulate(relative.begin(), relative.end(), 0.0) / static_cast<double>(pixels);
  error.mrse_error = standard_error(relative, image.width, image.height);
  error.rmse = std::sqrt(std::max(0.0, squares));
  error.bias = relative_difference(sum_v, sum_m);
  return error;
}

ImageError compare_images(const Image& image, const Image& reference) {
  ImageError error = image_error(image, reference);
  error.flip = mean_flip(image, reference);
  return error;
}

} // namespace vdbeam
