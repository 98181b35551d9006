#include "medium/medium_parts.h"

#include "tuning/constants.h"

#include <algorithm>
#include <numeric>

namespace vdbeam {

namespace {

constexpr std::size_t most_parts = 4;

} // namespace

MediumParts::MediumParts(std::span<const float> peaks) : of(peaks.size()) {
  std::vector<std::size_t> by_peak(peaks.size());
  std::iota(by_peak.begin(), by_peak.end(), std::size_t{0});
  std::stable_sort(by_peak.begin(), by_peak.end(),
                   [&](std::size_t a, std::size_t b) { return peaks[a] > peaks[b]; });
  float largest = peaks.empty() ? 0 : peaks[by_peak[0]];
  for (const std::size_t v : by_peak) {
    if (peaks[v] * tuning::widest_part < largest && count < most_parts) {
      ++count;
      largest = peaks[v];
    }
    of[v] = static_cast<std::uint8_t>(count - 1);
  }
}

} // namespace vdbeam
