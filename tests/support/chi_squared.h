#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace vdbeam::test {

/// P(X >= statistic) for a chi-squared X: the regularised upper incomplete gamma function, by the
/// series or the continued fraction (Numerical Recipes, 6.2).
inline double chi_squared_tail(double statistic, int degrees) {
  const double a = 0.5 * degrees, x = 0.5 * statistic;
  if (x <= 0)
    return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 100000 && term > sum * 1e-14; ++n)
      sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 100000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-14)
      break;
  }
  return front * h;
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
