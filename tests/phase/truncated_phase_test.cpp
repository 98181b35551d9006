// Phase functions whose forward peak is taken out keep their moments.
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
      EXPECT_NEAR(f + (1 - f) * legendre_moments(truncated.traced, 2)[1], moments[1], 1e-5);
    }
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
