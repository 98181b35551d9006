#include "scene/threads.h"

#include "scene/cgroups.h"

#include <tbb/info.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <string>

namespace vdbeam {
namespace {

int limit(int threads, int granted) {
  return granted > 0 ? std::min(threads, granted) : threads;
}

int variable(const char* name) {
  const char* text = std::getenv(name);
  if (!text)
    return 0;
  const std::string value(text);
  int number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() ? std::max(number, 0) : 0;
}

} // namespace

int thread_count(const RenderSettings& settings) {
  if (settings.threads > 0)
    return settings.threads;
  int threads = limit(tbb::info::default_concurrency(), cgroup_limits().cpus);
  for (const char* name : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"})
    threads = limit(threads, variable(name));
  return threads;
}

} // namespace vdbeam
