#include "errors/regional_bias.h"

#include "errors/history_means.h"

#include <limits>

namespace vdbeam {

namespace {

constexpr int regions_across = 2;

/// Region of a followed pixel.
std::size_t region_of(const PassHistory& history, std::size_t pixel) {
  const int x = static_cast<int>(pixel) % history.columns();
  const int y = static_cast<int>(pixel) / history.columns();
  return static_cast<std::size_t>(y * regions_across / history.rows() * regions_across +
                                  x * regions_across / history.columns());
}

} // namespace

RegionalBias::RegionalBias(const PassHistory& history,
                           const std::vector<Differences>& differences) {
  const std::vector<float> around =
      smoothed(mean_of(history, total_passes(history)), history.columns(), history.rows());
  for (const Differences& batch : differences) {
    std::vector<Sums> regions(regions_across * regions_across);
    for (std::size_t i = 0; i < batch.weights.size(); ++i) {
      Sums& region = regions[region_of(history, i)];
      region.all += batch.weights[i];
      bool differs = false;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t k = 3 * i + c;
        differs = differs || batch.sums[k] != 0;
        region.relative[c] += batch.sums[k] / (static_cast<double>(around[k]) + mrse_offset);
      }
      region.met += differs ? batch.weights[i] : 0;
    }
    batches_.push_back(std::move(regions));
  }
}

double RegionalBias::without(std::size_t left_out) const {
  double squares = 0, total = 0;
  for (std::size_t r = 0; r < regions_across * regions_across; ++r) {
    Sums sum;
    double own = 0, own_met = 0; // products of batches with themselves
    for (std::size_t b = 0; b < batches_.size(); ++b) {
      if (b == left_out)
        continue;
      const Sums& batch = batches_[b][r];
      for (std::size_t c = 0; c < 3; ++c) {
        sum.relative[c] += batch.relative[c];
        own += batch.relative[c] * batch.relative[c] / 3;
      }
      sum.met += batch.met;
      own_met += batch.met * batch.met;
      sum.all += batch.all;
    }
    double square = -own;
    for (const double relative : sum.relative)
      square += relative * relative / 3;
    if (const double pairs = sum.met * sum.met - own_met; pairs > 0)
      squares += sum.met * square / pairs;
    total += sum.all;
  }
  return total > 0 ? squares / total : std::numeric_limits<double>::quiet_NaN();
}

} // namespace vdbeam
