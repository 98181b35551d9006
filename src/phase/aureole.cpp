#include "phase/aureole.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbeam {

namespace {

constexpr double pi_double = 3.14159265358979323846;
constexpr int angle_count = 128, depth_count = 24;
/// The table's sums fall with the squares of the moments. A peak with more than this many moments
/// is a sixtieth of a degree wide.
constexpr double least_moment = 3e-3;
constexpr int most_moments = 4096;

/// Moments of the phase function from order 0 to where they are negligible.
std::vector<double> telling_moments(const PhaseFunction& phase) {
  for (int count = 64;; count *= 2) {
    std::vector<double> moments = legendre_moments(phase, count);
    if (count >= most_moments || std::abs(moments.back()) < least_moment)
      return moments;
  }
}

/// Optical depth of a row of the table; the last row stands for all greater depths.
double depth_of(int row) {
  return row + 1 < depth_count ? static_cast<double>(row) / (depth_count - 1 - row) : 1e9;
}

} // namespace

Aureole::Aureole(const PhaseFunction& phase, const TruncatedPhase& truncated, int order)
    : table_(static_cast<std::size_t>(depth_count) * angle_count) {
  const std::vector<double> moments = telling_moments(phase);
  const double forward = static_cast<double>(truncated.forward);
  // factors[l][row] = (2 l + 1) / (4 pi) f q_l (exp(-tau (1 - q_l)) - exp(-tau))
  std::vector<std::array<double, depth_count>> factors(moments.size());
  for (std::size_t l = 0; l < moments.size(); ++l) {
    const double q = l < static_cast<std::size_t>(order) ? 1 : std::min(1.0, moments[l] / forward);
    for (int row = 0; row < depth_count; ++row) {
      const double depth = depth_of(row);
      factors[l][static_cast<std::size_t>(row)] = (2 * static_cast<double>(l) + 1) /
                                                  (4 * pi_double) * forward * q *
                                                  (std::exp(-depth * (1 - q)) - std::exp(-depth));
    }
  }
  // The highest moment sets the width of the narrowest feature.
  const double first = 0.2 / static_cast<double>(moments.size());
  const double step = std::log(pi_double / first) / (angle_count - 1);
  first_angle_ = static_cast<float>(first);
  angles_per_log_ = static_cast<float>(1 / step);
  for (std::size_t column = 0; column < angle_count; ++column) {
    const double cosine = std::cos(first * std::exp(step * static_cast<double>(column)));
    std::array<double, depth_count> sums{};
    double before = 0, now = 1; // Legendre polynomials of the orders l - 1 and l
    for (std::size_t l = 0; l < moments.size(); ++l) {
      for (std::size_t row = 0; row < depth_count; ++row)
        sums[row] += factors[l][row] * now;
      const double n = static_cast<double>(l);
      const double next = ((2 * n + 1) * cosine * now - n * before) / (n + 1);
      before = now;
      now = next;
    }
    for (std::size_t row = 0; row < depth_count; ++row)
      table_[row * angle_count + column] = static_cast<float>(sums[row]);
  }
}

float Aureole::spread(float peak, float cosine, float depth) const {
  const float angle = std::acos(std::clamp(cosine, -1.0f, 1.0f));
  const float x = std::clamp(angles_per_log_ * std::log(std::max(angle, 1e-6f) / first_angle_),
                             0.0f, static_cast<float>(angle_count - 1));
  const float y = depth / (1 + depth) * static_cast<float>(depth_count - 1);
  const int column = std::min(static_cast<int>(x), angle_count - 2);
  const int row = std::min(static_cast<int>(y), depth_count - 2);
  const float fx = x - static_cast<float>(column), fy = y - static_cast<float>(row);
  const float* low = table_.data() + static_cast<std::size_t>(row * angle_count + column);
  const float* high = low + angle_count;
  const float a = low[0] + fx * (low[1] - low[0]), b = high[0] + fx * (high[1] - high[0]);
  return std::exp(-depth) * peak + a + fy * (b - a);
}

} // namespace vdbeam
