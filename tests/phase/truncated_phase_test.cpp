// Phase functions whose forward peak is taken out keep their moments.
#include "math/rng.h"
#include "phase/truncated_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace vdbeam {
namespace {

PhaseSettings settings(PhaseType type, double g = 0) {
  PhaseSettings result;
  result.type = type;
  result.g = g;
  return result;
}

/// The mean of P_l over the sphere's directions weighted by `value`, by the midpoint rule in the
/// logarithm of 1 - cos, which resolves peaks of any width.
double quadrature(const std::function<double(double)>& value, int l) {
  constexpr int steps = 40000;
  const double low = std::log(1e-10), high = std::log(2.0), width = (high - low) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = std::exp(low + (i + 0.5) * width);
    sum += 2 * M_PI * x * width * value(1 - x) * std::legendre(static_cast<unsigned>(l), 1 - x);
  }
  return sum;
}

std::vector<PhaseSettings> peaked() {
  PhaseSettings two_lobe = settings(PhaseType::two_lobe, 0.9);
  two_lobe.g2 = 0.3;
  two_lobe.blend = 0.4;
  return {settings(PhaseType::henyey_greenstein, 0.7), settings(PhaseType::henyey_greenstein, 0.95),
          settings(PhaseType::mie), two_lobe};
}

TEST(LegendreMoments, AreThoseOfTheFunction) {
  std::vector<PhaseSettings> all = peaked();
  all.push_back(settings(PhaseType::rayleigh));
  all.push_back(settings(PhaseType::henyey_greenstein, -0.6));
  for (const PhaseSettings& kind : all) {
    const PhaseFunction phase(kind);
    const std::vector<double> moments = legendre_moments(phase, 9);
    for (int l = 0; l < 9; ++l)
      EXPECT_NEAR(moments[l],
                  quadrature([&](double c) { return phase.evaluate(static_cast<float>(c)); }, l),
                  2e-3)
          << l;
  }
}

TEST(TruncatedPhase, PeakAndRestHaveTheMomentsOfTheWhole) {
  for (const PhaseSettings& kind : peaked())
    for (const int order : {4, 5, 8, 12}) {
      const PhaseFunction phase(kind);
      const std::vector<double> moments = legendre_moments(phase, order + 1);
      const TruncatedPhase truncated = truncate_peak(phase, order);
      if (moments[static_cast<std::size_t>(order)] < 0.05)
        continue;
      const double f = truncated.forward;
      EXPECT_NEAR(f, moments[static_cast<std::size_t>(order)], 1e-6);
      for (int l = 0; l < order; ++l) {
        const double rest = quadrature(
            [&](double c) { return truncated.gathered.evaluate(static_cast<float>(c)); }, l);
        EXPECT_NEAR(f + (1 - f) * rest, moments[static_cast<std::size_t>(l)], 2e-3) << l;
      }
      EXPECT_NEAR(f + (1 - f) * legendre_moments(truncated.traced, 2)[1], moments[1], 1e-4);
    }
}

/// Directions are drawn from p' itself wherever it is positive everywhere, and from something near
/// it elsewhere. A lobe of Henyey-Greenstein with the same mean cosine is up to 0.2 away.
TEST(TruncatedPhase, DirectionsHaveTheMomentsOfTheRest) {
  for (const double diameter : {8.0, 12.0, 20.0})
    for (const int order : {4, 6, 8}) {
      PhaseSettings kind = settings(PhaseType::mie);
      kind.droplet_diameter = diameter;
      const TruncatedPhase truncated = truncate_peak(PhaseFunction(kind), order);
      const std::vector<double> drawn = legendre_moments(truncated.traced, order);
      for (int l = 1; l < order; ++l)
        EXPECT_NEAR(
            drawn[static_cast<std::size_t>(l)],
            quadrature([&](double c) { return truncated.gathered.evaluate(static_cast<float>(c)); },
                       l),
            order == 4 ? 0.05 : 0.01)
            << diameter << " order " << order << " moment " << l;
    }
}

/// What is drawn is distributed as `evaluate` says.
TEST(TruncatedPhase, TableIsDrawnAsItIsEvaluated) {
  const PhaseFunction table = truncate_peak(PhaseFunction(settings(PhaseType::mie)), 5).traced;
  EXPECT_FALSE(table.isotropic());
  EXPECT_NEAR(quadrature([&](double c) { return table.evaluate(static_cast<float>(c)); }, 0), 1,
              1e-3);
  constexpr int bins = 16, draws = 40000;
  std::vector<double> found(bins), expected(bins);
  Rng rng({}, RngStage::test, 0);
  const Vec3f axis = normalize(Vec3f(1, 2, 3));
  for (int i = 0; i < draws; ++i) {
    const float u = rng.uniform(), v = rng.uniform(), w = rng.uniform();
    const float cosine = dot(axis, table.sample(axis, u, v, w));
    found[static_cast<std::size_t>(std::min(bins - 1.0f, (cosine + 1) / 2 * bins))] += 1;
  }
  double square = 0;
  for (int bin = 0; bin < bins; ++bin) {
    constexpr int steps = 2000;
    for (int i = 0; i < steps; ++i) {
      const double c = -1 + 2 * (bin + (i + 0.5) / steps) / bins;
      expected[bin] += 2 * std::numbers::pi * 2 / bins / steps * draws *
                       static_cast<double>(table.evaluate(static_cast<float>(c)));
    }
    square += (found[bin] - expected[bin]) * (found[bin] - expected[bin]) / expected[bin];
  }
  EXPECT_LT(square, 44.3); // chi squared of 15 degrees of freedom: a chance of 1e-4
}

TEST(TruncatedPhase, WithoutAForwardPeakStaysAsItIs) {
  for (const PhaseSettings& kind : {settings(PhaseType::isotropic), settings(PhaseType::rayleigh),
                                    settings(PhaseType::henyey_greenstein, 0.3),
                                    settings(PhaseType::henyey_greenstein, -0.9)}) {
    const PhaseFunction phase(kind);
    const TruncatedPhase truncated = truncate_peak(phase, 4);
    EXPECT_EQ(truncated.forward, 0);
    for (const float c : {-1.0f, 0.0f, 0.5f, 1.0f}) {
      EXPECT_EQ(truncated.gathered.evaluate(c), phase.evaluate(c));
      EXPECT_EQ(truncated.traced.evaluate(c), phase.evaluate(c));
    }
  }
}

TEST(TruncatedPhase, LessIsTakenOutByHigherOrders) {
  float before = 1;
  for (int order = least_truncation_order; order <= most_truncation_order; ++order) {
    const float forward =
        truncate_peak(PhaseFunction(settings(PhaseType::henyey_greenstein, 0.95)), order).forward;
    EXPECT_LT(forward, before);
    EXPECT_GT(forward, 0);
    before = forward;
  }
}

} // namespace
} // namespace vdbeam
