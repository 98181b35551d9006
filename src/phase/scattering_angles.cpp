#include "phase/scattering_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdbeam {

namespace {

/// Integral of p(cos theta) d theta, by the midpoints of equal parts.
double integral(const PhaseFunction& phase, double begin, double end) {
  constexpr int parts = 8;
  const double step = (end - begin) / parts;
  double sum = 0;
  for (int i = 0; i < parts; ++i)
    sum +=
        static_cast<double>(phase.evaluate(static_cast<float>(std::cos(begin + (i + 0.5) * step))));
  return sum * step;
}

} // namespace

ScatteringAngles::ScatteringAngles(const std::vector<PhaseFunction>& phases) {
  std::array<double, bins> of_phases{};
  for (const PhaseFunction& phase : phases) {
    std::array<double, bins> one{};
    double sum = 0;
    for (int i = 0; i < bins; ++i)
      sum += one[static_cast<std::size_t>(i)] = integral(phase, edge(i), edge(i + 1));
    for (std::size_t i = 0; i < bins; ++i)
      of_phases[i] += one[i] / (sum * static_cast<double>(phases.size()));
  }
  double sum = 0;
  for (int i = 0; i < bins; ++i) {
    sum += of_phases[static_cast<std::size_t>(i)];
    cumulative_[static_cast<std::size_t>(i) + 1] =
        0.5 * (edge(i + 1) / std::numbers::pi + std::min(sum, 1.0));
  }
}

double ScatteringAngles::edge(int bin) {
  const double x = static_cast<double>(bin) / bins;
  return std::numbers::pi * x * x * x;
}

int ScatteringAngles::bin_of(double angle) {
  return std::clamp(static_cast<int>(bins * std::cbrt(angle / std::numbers::pi)), 0, bins - 1);
}

double ScatteringAngles::cumulative(double angle) const {
  const int bin = bin_of(angle);
  return cumulative_[static_cast<std::size_t>(bin)] + (angle - edge(bin)) * density(angle);
}

double ScatteringAngles::inverse(double share) const {
  const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, share);
  const int bin = static_cast<int>(above - cumulative_.begin()) - 1;
  const double below = *(above - 1);
  return edge(bin) + (share - below) / (*above - below) * (edge(bin + 1) - edge(bin));
}

double ScatteringAngles::density(double angle) const {
  const int bin = bin_of(angle);
  const auto i = static_cast<std::size_t>(bin);
  return (cumulative_[i + 1] - cumulative_[i]) / (edge(bin + 1) - edge(bin));
}

} // namespace vdbeam
