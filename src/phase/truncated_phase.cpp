#include "phase/truncated_phase.h"

#include <algorithm>
#include <cmath>

namespace vdbeam {

namespace {

/// A peak with less than this share of the light is not worth a second medium.
constexpr double least_forward = 0.05;
constexpr double pi_double = 3.14159265358979323846;

/// Moments of a Draine lobe. Those of Henyey-Greenstein are g^l; cos^2 P_l is a sum of three
/// Legendre polynomials by the recurrence cos P_l = ((l + 1) P_{l + 1} + l P_{l - 1}) / (2 l + 1).
double lobe_moment(const DraineLobe& lobe, int l) {
  const double g = lobe.g, alpha = lobe.alpha;
  const auto up = [](int k) { return (k + 1.0) / (2 * k + 1); };
  const auto down = [](int k) { return k / (2.0 * k + 1); };
  const auto power = [&](int k) { return k == 0 ? 1.0 : std::pow(g, k); };
  double squared = up(l) * up(l + 1) * power(l + 2) + up(l) * down(l + 1) * power(l);
  if (l >= 1)
    squared += down(l) * up(l - 1) * power(l);
  if (l >= 2)
    squared += down(l) * down(l - 1) * power(l - 2);
  return (power(l) + alpha * squared) / (1 + alpha * (1 + 2 * g * g) / 3);
}

/// sum_l (2 l + 1) / (4 pi) * moments[l] * P_l as coefficients of the powers of the cosine.
std::vector<double> legendre_series(const std::vector<double>& moments) {
  const std::size_t count = moments.size();
  std::vector<double> before(count), now(count), sum(count);
  now[0] = 1; // P_0, and P_{-1} = 0
  for (std::size_t l = 0; l < count; ++l) {
    const double n = static_cast<double>(l), factor = (2 * n + 1) / (4 * pi_double) * moments[l];
    std::vector<double> next(count);
    for (std::size_t i = 0; i < count; ++i) {
      sum[i] += factor * now[i];
      if (i > 0)
        next[i] = (2 * n + 1) / (n + 1) * now[i - 1];
      next[i] -= n / (n + 1) * before[i];
    }
    before = std::move(now);
    now = std::move(next);
  }
  return sum;
}

} // namespace

std::vector<double> legendre_moments(const PhaseFunction& phase, int count) {
  std::vector<double> moments(static_cast<std::size_t>(count));
  for (int l = 0; l < count; ++l)
    for (int i = 0; i < phase.lobe_count(); ++i)
      moments[static_cast<std::size_t>(l)] +=
          static_cast<double>(phase.lobe(i).weight) * lobe_moment(phase.lobe(i), l);
  return moments;
}

TruncatedPhase truncate_peak(const PhaseFunction& phase, int order) {
  std::vector<double> moments = legendre_moments(phase, order + 1);
  const double forward = moments.back();
  moments.pop_back();
  // A forward peak shows in moments that fall slowly from 1; what falls below chi_M or was never
  // above it belongs to lobes of another form.
  const double least = *std::min_element(moments.begin(), moments.end());
  if (forward < least_forward || least <= forward)
    return {0, phase, phase};
  for (double& moment : moments)
    moment = (moment - forward) / (1 - forward);
  PhaseSettings traced;
  traced.type = PhaseType::henyey_greenstein;
  traced.g = moments[1];
  return {static_cast<float>(forward), PhaseFunction::polynomial(legendre_series(moments)),
          PhaseFunction(traced)};
}

} // namespace vdbeam
