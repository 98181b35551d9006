#include "render/bias_probe.h"

#include "machine/stopwatch.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// Probes are few rays, whose noise widens the interval of the error: each part of a ray's light
/// takes at least this many times the time of the ray (PathTrial::best_effort).
constexpr double least_time = 3;

/// The square of the bias is found from products of a pixel's own probes in different passes: few
/// pixels that are probed often are worth more than many that are probed once.
constexpr double most_passes_between_probes = 4;

/// Blur is measured at one in this many of the window's pixels, but at a minimum number of them.
constexpr double pixels_per_blur = 8, fewest_blurs = 512;

} // namespace

BiasProbe::BiasProbe(const EstimatorInput& input, const PixelRegion& window,
                     const std::vector<std::size_t>& pixels)
    : path_(input, least_time), window_(window), image_width_(input.camera.width()) {
  const double wanted = input.settings.bias_rays * window.width() * window.height();
  const double most = std::max(1.0, std::round(wanted)) * most_passes_between_probes;
  const double spacing = std::max(1.0, static_cast<double>(pixels.size()) / most);
  for (double next = 0; next < static_cast<double>(pixels.size()); next += spacing)
    pixels_.push_back(pixels[static_cast<std::size_t>(next)]);
  const double period = static_cast<double>(pixels_.size()) / std::max(wanted, 1.0);
  period_ = static_cast<std::size_t>(std::max(1.0, std::round(period)));
}

std::vector<PixelValue> BiasProbe::trace(const PassSpec& spec, RenderStatistics& statistics) {
  const Stopwatch watch;
  std::vector<PixelValue> probes;
  std::vector<std::size_t> image_pixels;
  // Every period-th pixel in an order that jumps, so that a pass does not probe columns.
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if ((mix64(i) + static_cast<std::uint64_t>(spec.probe_turn)) % period_ != 0)
      continue;
    const auto width = static_cast<std::size_t>(window_.width());
    const std::size_t x = window_.x0 + pixels_[i] % width, y = window_.y0 + pixels_[i] / width;
    probes.push_back({pixels_[i], {}});
    image_pixels.push_back(y * static_cast<std::size_t>(image_width_) + x);
  }
  const std::vector<Rgb> radiance = path_.radiance(spec.pass, image_pixels);
  for (std::size_t i = 0; i < probes.size(); ++i)
    probes[i].radiance = radiance[i];
  statistics.bias_rays += probes.size();
  statistics.bias += watch.seconds();
  return probes;
}

std::vector<std::size_t> choose_blur_pixels(const PixelRegion& window, int image_width,
                                            const std::vector<std::size_t>& pixels) {
  const double area = static_cast<double>(window.width()) * window.height();
  const double most = std::max(fewest_blurs, area / pixels_per_blur);
  const double spacing = std::max(1.0, static_cast<double>(pixels.size()) / most);
  std::vector<std::size_t> chosen;
  for (double next = 0; next < static_cast<double>(pixels.size()); next += spacing) {
    const std::size_t pixel = pixels[static_cast<std::size_t>(next)];
    const auto width = static_cast<std::size_t>(window.width());
    const std::size_t x = static_cast<std::size_t>(window.x0) + pixel % width;
    const std::size_t y = static_cast<std::size_t>(window.y0) + pixel / width;
    chosen.push_back(y * static_cast<std::size_t>(image_width) + x);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

} // namespace vdbeam
