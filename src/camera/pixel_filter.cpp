#include "camera/pixel_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

constexpr int intervals = 1024;

/// At x in [0, 1] over the filter's width.
double profile(PixelFilter filter, double x) {
  if (filter == PixelFilter::gaussian) {
    const double deviations = 6 * (x - 0.5); // the width holds three to each side
    return std::exp(-0.5 * deviations * deviations);
  }
  // Harris 1978, four terms, -92 dB.
  const double phase = 2 * std::numbers::pi * x;
  return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) -
         0.01168 * std::cos(3 * phase);
}

} // namespace

FilterSampler::FilterSampler(PixelFilter filter, double width)
    : width_(width > 0 ? width : usual_width(filter)) {
  if (filter == PixelFilter::box)
    return;
  cumulative_.push_back(0);
  for (int i = 0; i < intervals; ++i)
    cumulative_.push_back(cumulative_.back() + profile(filter, (i + 0.5) / intervals));
  const double total = cumulative_.back();
  for (double& value : cumulative_)
    value /= total;
}

double FilterSampler::offset(double u) const {
  if (cumulative_.empty())
    return width_ == 1 ? u : 0.5 + (u - 0.5) * width_;
  const auto next = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, u);
  const double low = *(next - 1), high = *next;
  const double interval = static_cast<double>(next - cumulative_.begin() - 1);
  const double x = (interval + (u - low) / (high - low)) / intervals;
  return 0.5 + (x - 0.5) * width_;
}

} // namespace vdbeam
