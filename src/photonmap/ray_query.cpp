#include "photonmap/map_queries.h"
#include <hwy/targets.h>
namespace vdbeam {
std::vector<std::int64_t> simd_targets() {
  std::vector<std::int64_t> targets;
  hwy::SetSupportedTargetsForTest(0);
  const std::int64_t compiled = HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_STATIC_TARGET;
  const std::int64_t all = hwy::SupportedTargets() & compiled;
  for (std::int64_t bits = all; bits != 0; bits &= bits - 1)
    targets.push_back(bits & -bits);
  return targets;
}

void confine_simd_targets(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

const char* simd_target() {
  const std::int64_t targets =
      hwy::SupportedTargets() & (HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_STATIC_TARGET);
  return hwy::TargetName(targets & -targets);
}
} // namespace vdbeam
