#include "scene/threads.h"

#include <tbb/info.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

namespace vdbeam {
namespace {

std::string read_small_file(const std::string& path) {
  std::ifstream stream(path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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

/// The least limit of this process' group and all above it.
int limit_by_cgroups(int threads) {
  std::string group = read_small_file("/proc/self/cgroup");
  const std::size_t unified = group.find("0::");
  if (unified != std::string::npos) {
    group = group.substr(unified + 3, group.find('\n', unified) - unified - 3);
    while (true) {
      threads = limit(threads, cgroup_cpus(read_small_file("/sys/fs/cgroup" + group + "/cpu.max")));
      const std::size_t slash = group.rfind('/');
      if (slash == std::string::npos || group.empty())
        break;
      group.erase(slash);
    }
  }
  // Version 1; -1 is no limit.
  const std::string folder = "/sys/fs/cgroup/cpu/cpu.cfs_";
  std::string quota = read_small_file(folder + "quota_us");
  std::replace(quota.begin(), quota.end(), '\n', ' ');
  return limit(threads, cgroup_cpus(quota + read_small_file(folder + "period_us")));
}

} // namespace

int cgroup_cpus(const std::string& text) {
  double quota = 0, period = 0;
  std::istringstream stream(text);
  if (!(stream >> quota >> period) || !(quota > 0) || !(period > 0))
    return 0;
  return static_cast<int>(std::ceil(std::min(quota / period, 65536.0)));
}

int thread_count(const RenderSettings& settings) {
  if (settings.threads > 0)
    return settings.threads;
  int threads = limit_by_cgroups(tbb::info::default_concurrency());
  for (const char* name : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"})
    threads = limit(threads, variable(name));
  return threads;
}

} // namespace vdbeam
