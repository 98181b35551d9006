#pragma once

#include <boost/math/distributions/chi_squared.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace vdbeam::test {

/// P(X >= statistic) for a chi-squared X.
inline double chi_squared_tail(double statistic, int degrees) {
  return cdf(complement(boost::math::chi_squared(degrees), statistic));
}

/// Pearson's test of counts against expected counts (of the same total); bins that expect fewer
/// than 5 are merged with the following ones. Returns the p-value.
inline double chi_squared_test(const std::vector<double>& counts,
                               const std::vector<double>& expected) {
  double statistic = 0, seen = 0, hoped = 0;
  int bins = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    seen += counts[i];
    hoped += expected[i];
    if (hoped < 5 && i + 1 < counts.size())
      continue;
    if (hoped > 0)
      statistic += (seen - hoped) * (seen - hoped) / hoped, ++bins;
    else if (seen > 0)
      return 0;
    seen = hoped = 0;
  }
  return bins < 2 ? 1 : chi_squared_tail(statistic, bins - 1);
}

/// Each of n tests at this level gives a family-wise level of 0.001 (Sidak).
inline double family_level(int n) {
  return 1 - std::pow(1 - 1e-3, 1.0 / n);
}

} // namespace vdbeam::test
