// The density of scattering angles: half even, half by the phase functions.
#include "phase/scattering_angles.h"

#include "support/memory_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vdbeam {
namespace {

PhaseFunction droplets() {
  PhaseSettings settings;
  settings.type = PhaseType::mie;
  settings.droplet_diameter = 20;
  return PhaseFunction(settings);
}

TEST(ScatteringAngles, AnglesAndSharesAreInverse) {
  const ScatteringAngles angles({droplets(), PhaseFunction(test::henyey_greenstein(-0.6))});
  EXPECT_EQ(angles.cumulative(0), 0);
  EXPECT_NEAR(angles.cumulative(std::numbers::pi), 1, 1e-9);
  double before = 0;
  for (const double angle : {1e-7, 1e-5, 1e-3, 0.02, 0.4, 1.7, 3.0, 3.14}) {
    const double share = angles.cumulative(angle);
    EXPECT_GT(share, before);
    EXPECT_NEAR(angles.inverse(share), angle, 1e-9 * angle + 1e-15);
    before = share;
  }
}

TEST(ScatteringAngles, DensityIsTheSlopeOfTheShare) {
  const ScatteringAngles angles({droplets()});
  for (const double angle : {1e-4, 0.003, 0.1, 1.0, 2.5}) {
    const double step = 1e-7 * angle;
    EXPECT_NEAR((angles.cumulative(angle + step) - angles.cumulative(angle)) / step,
                angles.density(angle), 1e-4 * angles.density(angle));
  }
}

/// No angle is drawn much more rarely than it counts.
TEST(ScatteringAngles, FollowThePhaseFunction) {
  for (const PhaseFunction& phase : {droplets(), PhaseFunction(test::henyey_greenstein(0.9)),
                                     PhaseFunction(test::henyey_greenstein(-0.5))}) {
    const ScatteringAngles angles({phase});
    double integral = 0;
    constexpr int steps = 2000000;
    for (int i = 0; i < steps; ++i)
      integral += static_cast<double>(phase.evaluate(
                      static_cast<float>(std::cos(std::numbers::pi * (i + 0.5) / steps)))) *
                  std::numbers::pi / steps;
    for (double angle = 1e-6; angle < std::numbers::pi; angle *= 1.1) {
      const auto p = static_cast<double>(phase.evaluate(static_cast<float>(std::cos(angle))));
      EXPECT_LT(p / integral / angles.density(angle), 2.5) << angle;
    }
    EXPECT_NEAR(angles.density(1.5),
                0.5 / std::numbers::pi +
                    0.5 * static_cast<double>(phase.evaluate(static_cast<float>(std::cos(1.5)))) /
                        integral,
                0.02 * angles.density(1.5));
  }
}

} // namespace
} // namespace vdbeam
