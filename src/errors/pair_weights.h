#pragma once

#include "errors/pass_history.h"

#include <cstddef>
#include <vector>

namespace vdbeam {

/// Differences of a batch of passes to something that is known better, by followed pixel.
struct Differences {
  std::vector<double> sums, weights; ///< sums are R, G, B
};

/// 1 / (mean + mrse_offset)^2 of a pixel's channel, by which the product of two batches'
/// differences is weighed. A weight must know nothing of what it weighs, so it comes from all other
/// batches. The mean is meant to be that of the true picture: where kernels blur, their blur is
/// taken off it, or dark pixels beside a bright rim would seem to have less error than they have.
class PairWeights {
public:
  /// `blurs`: by batch, the bias of the kernels estimated from their blur; empty weights if it
  /// was not measured. Both must outlive this.
  PairWeights(const PassHistory& history, const std::vector<Differences>& blurs);

  /// For the batches i and j, and value k of the followed pixels (R, G, B of each).
  double operator()(std::size_t i, std::size_t j, std::size_t k) const;

private:
  void add_deviations(std::size_t batch, std::size_t k);
  double sum(std::size_t batch, std::size_t k) const {
    return static_cast<double>(history_.sums(batch)[k]);
  }

  const PassHistory& history_;
  const std::vector<Differences>& blurs_;
  double passes_;
  std::vector<float> means_, around_;
  std::vector<double> blur_sums_, blur_counts_;    ///< of all batches
  std::vector<double> variances_, blur_variances_; ///< of one pass
};

} // namespace vdbeam
