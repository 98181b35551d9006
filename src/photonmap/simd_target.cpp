#include "photonmap/map_queries.h"

#include <hwy/targets.h>

namespace vdbeam {
namespace {

/// Targets for which the queries are compiled; the others would add nothing (see the queries'
/// sources).
constexpr std::int64_t compiled = HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_STATIC_TARGET;
/// Highway's MulAdd rounds twice on these, once on all others.
constexpr std::int64_t without_fma = HWY_SSSE3 | HWY_SSE4 | HWY_EMU128 | HWY_SCALAR;

/// The one that queries run on.
std::int64_t chosen_target() {
  const std::int64_t targets = hwy::SupportedTargets() & compiled;
  return targets & -targets;
}

} // namespace

std::vector<std::int64_t> simd_targets() {
  confine_simd_targets(0);
  std::vector<std::int64_t> targets;
  for (std::int64_t bits = hwy::SupportedTargets() & compiled; bits != 0; bits &= bits - 1)
    targets.push_back(bits & -bits);
  return targets;
}

void confine_simd_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

const char* simd_target() {
  return hwy::TargetName(chosen_target());
}

bool simd_is_fused() {
  return (chosen_target() & without_fma) == 0;
}

} // namespace vdbeam
