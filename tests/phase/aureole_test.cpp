// The aureole about a light has the moments of small-angle scattering.
#include "phase/aureole.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace vdbeam {
namespace {

PhaseFunction henyey_greenstein_phase(double g) {
  PhaseSettings settings;
  settings.type = PhaseType::henyey_greenstein;
  settings.g = g;
  return PhaseFunction(settings);
}

PhaseFunction mie_phase(double diameter) {
  PhaseSettings settings;
  settings.type = PhaseType::mie;
  settings.droplet_diameter = diameter;
  return PhaseFunction(settings);
}

/// The integral over all directions of value(cos) P_l(cos).
double integral(const std::function<float(float)>& value, unsigned l = 0) {
  constexpr int steps = 20000;
  const double low = std::log(1e-9), width = (std::log(2.0) - low) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = std::exp(low + (i + 0.5) * width);
    sum += 2 * M_PI * x * width * static_cast<double>(value(static_cast<float>(1 - x))) *
           std::legendre(l, 1 - x);
  }
  return sum;
}

constexpr int order = 4;

class AureoleOf : public ::testing::TestWithParam<PhaseFunction> {
protected:
  float spread(float cosine, double depth) const {
    const float peak =
        phase.evaluate(cosine) - (1 - truncated.forward) * truncated.gathered.evaluate(cosine);
    return aureole.spread(peak, cosine, static_cast<float>(depth));
  }
  double moment(double depth, int l) const {
    return integral([&](float c) { return spread(c, depth); }, static_cast<unsigned>(l));
  }

  PhaseFunction phase = GetParam();
  TruncatedPhase truncated = truncate_peak(phase, order);
  double forward = static_cast<double>(truncated.forward);
  Aureole aureole{phase, truncated, order};
};

TEST_P(AureoleOf, IsThePeakWhereNothingScattersBefore) {
  for (const float cosine : {1.0f, 0.9999f, 0.99f, 0.9f, 0.5f, 0.0f, -1.0f}) {
    const float p = phase.evaluate(cosine);
    const float smooth = (1 - truncated.forward) * truncated.gathered.evaluate(cosine);
    EXPECT_NEAR(smooth + spread(cosine, 0), p, 1e-4f * p) << cosine;
  }
}

TEST_P(AureoleOf, KeepsTheMomentsBelowItsOrder) {
  for (const double depth : {0.3, 1.0, 4.0, 10.0})
    for (int l = 0; l < order; ++l)
      EXPECT_NEAR(moment(depth, l), forward, 0.01 * forward) << "depth " << depth << " order " << l;
}

/// From M on they are those of light that the peak has scattered as often as Poisson says.
TEST_P(AureoleOf, HigherMomentsFallByDepth) {
  const std::vector<double> chi = legendre_moments(phase, 12);
  for (const double depth : {0.3, 1.0, 4.0, 10.0})
    for (int l = order; l < 12; ++l) {
      const double q = chi[static_cast<std::size_t>(l)] / forward;
      EXPECT_NEAR(moment(depth, l), forward * q * std::exp(-depth * (1 - q)), 0.01 * forward)
          << "depth " << depth << " order " << l;
    }
}

std::string phase_name(const ::testing::TestParamInfo<PhaseFunction>& info) {
  return std::array{"G07", "G085", "G095", "Droplets8", "Droplets20"}[info.index];
}

INSTANTIATE_TEST_SUITE_P(Peaks, AureoleOf,
                         ::testing::Values(henyey_greenstein_phase(0.7),
                                           henyey_greenstein_phase(0.85),
                                           henyey_greenstein_phase(0.95), mie_phase(8),
                                           mie_phase(20)),
                         phase_name);

} // namespace
} // namespace vdbeam
