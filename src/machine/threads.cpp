#include "machine/threads.h"

#include "machine/cgroups.h"
#include "machine/farm_grants.h"

#include <tbb/info.h>

#include <algorithm>

namespace vdbeam {
namespace {

int limit(int threads, int granted) {
  return granted > 0 ? std::min(threads, granted) : threads;
}

} // namespace

int thread_count(const RenderSettings& settings) {
  if (settings.threads > 0)
    return settings.threads;
  return limit(limit(tbb::info::default_concurrency(), cgroup_limits().cpus), farm_threads());
}

} // namespace vdbeam
