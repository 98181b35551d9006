#pragma once

#include "photonmap/query_oracle.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vdbeam::oracle {

inline PhaseFunction henyey_greenstein(double g) {
  PhaseSettings settings;
  settings.type = PhaseType::henyey_greenstein;
  settings.g = g;
  return PhaseFunction(settings);
}

inline PhaseFunction two_lobes() {
  PhaseSettings settings;
  settings.type = PhaseType::two_lobe;
  settings.g = 0.7;
  settings.g2 = -0.4;
  settings.blend = 0.3;
  return PhaseFunction(settings);
}

inline PhaseFunction rayleigh() {
  PhaseSettings settings;
  settings.type = PhaseType::rayleigh;
  return PhaseFunction(settings);
}

/// Rays through the cube about the origin.
inline BeamTile cube_tile(const std::vector<PhaseFunction>& phases) {
  TileOptions options;
  options.reference = {0, 0, 0};
  options.distance = 3;
  options.pixel = 0.004;
  options.t_begin = -1;
  options.t_end = 1;
  return make_tile(options, phases);
}

/// Runs `check` on every SIMD target that this machine has.
inline void on_every_target(const std::function<void()>& check) {
  for (const std::int64_t target : simd_targets()) {
    confine_simd_targets(target);
    SCOPED_TRACE(simd_target());
    check();
  }
  confine_simd_targets(0);
}

/// Holds `values()` to the same bits on every SIMD target that fuses multiply-add.
inline void expect_same_bits(const std::function<std::vector<float>()>& values) {
  std::vector<float> first;
  on_every_target([&] {
    if (!simd_is_fused())
      return;
    const std::vector<float> found = values();
    if (first.empty())
      first = found;
    ASSERT_EQ(found.size(), first.size());
    EXPECT_EQ(std::memcmp(found.data(), first.data(), first.size() * sizeof(float)), 0);
  });
}

inline std::vector<std::vector<PhaseFunction>> phase_sets() {
  return {{PhaseFunction()},
          {henyey_greenstein(0.6)},
          {two_lobes()},
          {rayleigh()},
          {henyey_greenstein(-0.95)},
          {henyey_greenstein(0.5), PhaseFunction(), two_lobes()}};
}

/// A single-precision cosine is off by 2e-7, so x^(-3/2) with x >= (1 - |g|)^2 by that over x.
inline double phase_rounding(const std::vector<PhaseFunction>& phases) {
  double worst = 0;
  for (const PhaseFunction& phase : phases)
    for (int i = 0; i < phase.lobe_count(); ++i)
      worst = std::max(worst, 6e-7 / std::pow(1 - std::abs(phase.lobe(i).g), 2));
  return worst;
}

} // namespace vdbeam::oracle
