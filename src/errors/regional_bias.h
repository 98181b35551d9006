#pragma once

#include "errors/pair_weights.h"

#include <cstddef>
#include <vector>

namespace vdbeam {

/// The squared bias of the means of a few large regions, as MRSE. Differences that all pixels of a
/// region have in common stand out of the noise long before those of single pixels do.
class RegionalBias {
public:
  /// `differences`: by batch.
  RegionalBias(const PassHistory& history, const std::vector<Differences>& differences);

  /// Mean product of different batches' sums, in which independent noise cancels; NaN where
  /// there are too few. The batch `left_out` is not counted; none is with the number of batches.
  double without(std::size_t left_out) const;

private:
  /// Sums over one batch and one region.
  struct Sums {
    double relative[3] = {}; ///< differences to the mean brightness, R, G, B
    double met = 0;          ///< weight of the pixels that differ at all: those that see the medium
    double all = 0;
  };

  std::vector<std::vector<Sums>> batches_; ///< by region
};

} // namespace vdbeam
