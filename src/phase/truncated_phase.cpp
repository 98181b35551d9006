#include "phase/truncated_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

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

/// A table of the phase function proportional to max(0, p') exp(a cos): p' is a truncated series
/// and may be negative, which no direction can be drawn from. `a` keeps the mean cosine, on which
/// diffusion rests, at that of p'.
///
/// Henyey-Greenstein of the same mean cosine would be simpler. For droplets, what is left without
/// the peak is of another shape: a slab of 15 mean free paths then came out up to 19 % too bright,
/// and with this table up to 5 % (research-log/decisions.md).
PhaseFunction positive_part(const PhaseFunction& series, double mean_cosine) {
  constexpr int cells = 4096, shares = 1024;
  constexpr double width = 2.0 / cells;
  const auto cosine = [](int cell) { return -1 + (cell + 0.5) * width; };
  std::vector<double> positive(cells), tilted(cells);
  for (int i = 0; i < cells; ++i)
    positive[i] =
        std::max(0.0, static_cast<double>(series.evaluate(static_cast<float>(cosine(i)))));
  double tilt = 0, mass = 0;
  for (int step = 0; step < 50; ++step) { // Newton's method; the derivative is the variance
    double mean = 0, square = 0;
    mass = 0;
    for (int i = 0; i < cells; ++i) {
      const double c = cosine(i);
      tilted[i] = positive[i] * std::exp(tilt * c);
      mass += tilted[i];
      mean += tilted[i] * c;
      square += tilted[i] * c * c;
    }
    mean /= mass;
    const double lacks = mean_cosine - mean;
    if (std::abs(lacks) < 1e-9)
      break;
    tilt += std::clamp(lacks / (square / mass - mean * mean), -1.0, 1.0);
  }
  std::vector<float> cosines{-1};
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    const double before = sum;
    sum += tilted[i];
    for (double next = static_cast<double>(cosines.size()) / shares * mass;
         cosines.size() < shares && next <= sum;
         next = static_cast<double>(cosines.size()) / shares * mass)
      cosines.push_back(static_cast<float>(-1 + (i + (next - before) / tilted[i]) * width));
  }
  cosines.push_back(1);
  return PhaseFunction::table(std::move(cosines));
}

/// Mean of P_l over the cosines from a to b: P_l integrates to (P_{l + 1} - P_{l - 1}) / (2 l + 1).
double mean_legendre(int l, double a, double b) {
  const auto integral = [l](double x) {
    double before = 1, now = x; // P_{l - 1} and P_l
    if (l == 0)
      return x;
    for (int k = 1; k < l; ++k)
      before = std::exchange(now, ((2 * k + 1) * x * now - k * before) / (k + 1));
    const double next = ((2 * l + 1) * x * now - l * before) / (l + 1);
    return (next - before) / (2 * l + 1);
  };
  return (integral(b) - integral(a)) / (b - a);
}

} // namespace

std::vector<double> legendre_moments(const PhaseFunction& phase, int count) {
  std::vector<double> moments(static_cast<std::size_t>(count));
  if (const std::vector<float>* c = phase.cosines())
    for (int l = 0; l < count; ++l)
      for (std::size_t i = 0; i + 1 < c->size(); ++i)
        moments[static_cast<std::size_t>(l)] +=
            mean_legendre(l, static_cast<double>((*c)[i]), static_cast<double>((*c)[i + 1])) /
            static_cast<double>(c->size() - 1);
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
  TruncatedPhase result;
  result.forward = static_cast<float>(forward);
  result.gathered = PhaseFunction::polynomial(legendre_series(moments));
  result.traced = positive_part(result.gathered, moments[1]);
  return result;
}

} // namespace vdbeam
