#include "errors/pair_weights.h"

#include "errors/history_means.h"
#include "tuning/constants.h"

#include <algorithm>

namespace vdbeam {

namespace {

/// How much of a blur of the given variance counts, from 0 to 1.
double believed(double blur, double mean, double variance) {
  const auto half_at = [](double square, double half) {
    return square > 0 ? square / (square + half) : 0;
  };
  return half_at(blur * blur, tuning::half_believed_blur * tuning::half_believed_blur * variance) *
         half_at(mean * mean,
                 variance / (tuning::half_believed_share * tuning::half_believed_share));
}

double mean_or_zero(double sum, double count) {
  return count > 0 ? sum / count : 0;
}

} // namespace

PairWeights::PairWeights(const PassHistory& history, const std::vector<Differences>& blurs)
    : history_(history), blurs_(blurs), passes_(total_passes(history)),
      means_(mean_of(history, passes_)),
      around_(smoothed(means_, history.columns(), history.rows())), blur_sums_(means_.size()),
      blur_counts_(means_.size() / 3), variances_(means_.size()), blur_variances_(means_.size()) {
  for (const Differences& batch : blurs) {
    for (std::size_t k = 0; k < blur_sums_.size(); ++k)
      blur_sums_[k] += batch.sums[k];
    for (std::size_t g = 0; g < blur_counts_.size(); ++g)
      blur_counts_[g] += batch.weights[g];
  }
  for (std::size_t k = 0; k < means_.size(); ++k)
    for (std::size_t batch = 0; batch < history.batches(); ++batch)
      add_deviations(batch, k);
}

void PairWeights::add_deviations(std::size_t batch, std::size_t k) {
  const double degrees = static_cast<double>(history_.batches() - 1);
  const double passes = history_.passes(batch), blurs = blurs_[batch].weights[k / 3];
  const double mean = sum(batch, k) / passes - static_cast<double>(means_[k]);
  const double blur =
      mean_or_zero(blurs_[batch].sums[k], blurs) - mean_or_zero(blur_sums_[k], blur_counts_[k / 3]);
  variances_[k] += passes * (mean - blur) * (mean - blur) / degrees;
  blur_variances_[k] += blurs * blur * blur / degrees;
}

double PairWeights::operator()(std::size_t i, std::size_t j, std::size_t k) const {
  const double others = passes_ - history_.passes(i) - history_.passes(j);
  const double neighbours =
      tuning::weight_of_neighbours * passes_ / static_cast<double>(history_.batches());
  const double expected = std::max(0.0, (static_cast<double>(means_[k]) * passes_ - sum(i, k) -
                                         sum(j, k) + neighbours * static_cast<double>(around_[k])) /
                                            (others + neighbours));
  const double blurs = blur_counts_[k / 3] - blurs_[i].weights[k / 3] - blurs_[j].weights[k / 3];
  double blur = 0, belief = 0;
  if (blurs > 0) {
    blur = (blur_sums_[k] - blurs_[i].sums[k] - blurs_[j].sums[k]) / blurs;
    belief = believed(blur, expected, blur_variances_[k] / blurs);
  }
  const double m = std::max({expected - belief * blur, tuning::least_unblurred * expected,
                             (1 - belief) * static_cast<double>(around_[k])});
  const double spread = variances_[k] * others / ((others + neighbours) * (others + neighbours));
  return 1 / ((m + mrse_offset) * (m + mrse_offset) + 3 * spread);
}

} // namespace vdbeam
