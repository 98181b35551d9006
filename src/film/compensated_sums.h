#pragma once

#include "math/zeroed_array.h"

#include <bit>
#include <cstdint>

namespace vdbeam {

/// One sum per value, each a double and a float of what the double rounded off: 77 bits, 12 bytes.
/// 100,000 floats of like size need 41 bits, so sums are exact, and the same for any order and
/// grouping, unless values differ by more than 2^36; beyond that the error is 2^-77 of the sum.
class CompensatedSums {
public:
  static constexpr std::size_t bytes_per_value = sizeof(double) + sizeof(float);

  explicit CompensatedSums(std::size_t count) : high_(count), low_(count) {}

  void add(std::size_t i, double value);
  /// Adds another's sum `i`.
  void merge(std::size_t i, const CompensatedSums& other);
  double high(std::size_t i) const { return high_[i]; }
  float low(std::size_t i) const { return low_[i]; }
  std::size_t size() const { return high_.size(); }
  double* high_data() { return high_.data(); }
  float* low_data() { return low_.data(); }

private:
  ZeroedArray<double> high_;
  ZeroedArray<float> low_;
};

/// a + b exactly, as a rounded sum and its error: Knuth, The Art of Computer Programming 2, section
/// 4.2.2, theorem B. Needs arithmetic without re-association.
struct ExactSum {
  double rounded, error;
};
inline ExactSum two_sum(double a, double b) {
  const double s = a + b, t = s - a;
  return {s, (a - (s - t)) + (b - t)};
}

inline void CompensatedSums::add(std::size_t i, double value) {
  const ExactSum sum = two_sum(high_[i], value);
  const ExactSum renormalised = two_sum(sum.rounded, low_[i] + sum.error);
  high_[i] = renormalised.rounded;
  low_[i] = static_cast<float>(renormalised.error);
}

inline void CompensatedSums::merge(std::size_t i, const CompensatedSums& other) {
  const ExactSum sum = two_sum(high_[i], other.high_[i]);
  const double low = double{low_[i]} + other.low_[i] + sum.error;
  const ExactSum renormalised = two_sum(sum.rounded, low);
  high_[i] = renormalised.rounded;
  low_[i] = static_cast<float>(renormalised.error);
}

// On the bits, since comparisons of floats may trap and so keep compilers from vectorising.
inline std::uint32_t is_finite(float value) {
  return (std::bit_cast<std::uint32_t>(value) & 0x7f800000u) != 0x7f800000u ? 1 : 0;
}
inline float finite_or_zero(float value) {
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & (0u - is_finite(value)));
}

} // namespace vdbeam
