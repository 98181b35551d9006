#include "errors/history_means.h"

#include <algorithm>

namespace vdbeam {

std::vector<float> mean_of(const PassHistory& history, double passes) {
  std::vector<double> sums(3 * history.pixels().size());
  for (std::size_t batch = 0; batch < history.batches(); ++batch)
    for (std::size_t i = 0; i < sums.size(); ++i)
      sums[i] += static_cast<double>(history.sums(batch)[i]);
  std::vector<float> means(sums.size());
  std::transform(sums.begin(), sums.end(), means.begin(),
                 [&](double sum) { return static_cast<float>(sum / passes); });
  return means;
}

std::vector<float> smoothed(const std::vector<float>& means, int columns, int rows) {
  std::vector<float> result(means.size());
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int from =
              std::clamp(y + dy, 0, rows - 1) * columns + std::clamp(x + dx, 0, columns - 1);
          for (int c = 0; c < 3; ++c)
            result[static_cast<std::size_t>(3 * (y * columns + x) + c)] +=
                means[static_cast<std::size_t>(3 * from + c)] / 9;
        }
  return result;
}

double total_passes(const PassHistory& history) {
  double passes = 0;
  for (std::size_t batch = 0; batch < history.batches(); ++batch)
    passes += history.passes(batch);
  return passes;
}

} // namespace vdbeam
