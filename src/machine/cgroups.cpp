#include "machine/cgroups.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace vdbeam {
namespace {

/// The least of two limits, 0 being none.
template <class T>
T least(T a, T b) {
  return a == 0 || (b != 0 && b < a) ? b : a;
}

std::string first_line(const std::string& path) {
  std::ifstream stream(path);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// "150000 100000": microseconds of processor time in each period; "max" or -1 is no limit.
int parse_cpus(const std::string& text) {
  double quota = 0, period = 0;
  std::istringstream stream(text);
  if (!(stream >> quota >> period) || !(quota > 0) || !(period > 0))
    return 0;
  return static_cast<int>(std::ceil(std::min(quota / period, 65536.0)));
}

/// Bytes, or "max". Version 1 writes a number near 2^63 for no limit, which is no less than any
/// memory.
std::uint64_t parse_memory(const std::string& text) {
  std::uint64_t bytes = 0;
  std::istringstream stream(text);
  return stream >> bytes ? bytes : 0;
}

/// Calls `read` with the folder of a group and those of all groups above it.
template <class F>
void for_each_level(const std::string& mount, std::string group, F read) {
  while (true) {
    read(mount + group);
    const std::size_t slash = group.rfind('/');
    if (slash == std::string::npos)
      return;
    group.erase(slash);
  }
}

bool names(const std::string& controllers, const std::string& wanted) {
  std::istringstream stream(controllers);
  for (std::string name; std::getline(stream, name, ',');)
    if (name == wanted)
      return true;
  return false;
}

/// One line of /proc/self/cgroup: "0::/group" of version 2, "4:cpu,cpuacct:/group" of version 1.
void add_limits(const std::string& line, const std::string& mounts, CgroupLimits& limits) {
  const std::size_t first = line.find(':'), second = line.find(':', first + 1);
  if (first == std::string::npos || second == std::string::npos)
    return;
  const std::string controllers = line.substr(first + 1, second - first - 1);
  std::string group = line.substr(second + 1);
  if (group == "/")
    group.clear();
  if (controllers.empty())
    for_each_level(mounts, group, [&](const std::string& folder) {
      limits.cpus = least(limits.cpus, parse_cpus(first_line(folder + "/cpu.max")));
      limits.memory = least(limits.memory, parse_memory(first_line(folder + "/memory.max")));
    });
  if (names(controllers, "cpu"))
    for_each_level(mounts + "/cpu", group, [&](const std::string& folder) {
      limits.cpus = least(limits.cpus, parse_cpus(first_line(folder + "/cpu.cfs_quota_us") + " " +
                                                  first_line(folder + "/cpu.cfs_period_us")));
    });
  if (names(controllers, "memory"))
    for_each_level(mounts + "/memory", group, [&](const std::string& folder) {
      limits.memory =
          least(limits.memory, parse_memory(first_line(folder + "/memory.limit_in_bytes")));
    });
}

} // namespace

CgroupLimits cgroup_limits(const std::string& root) {
  CgroupLimits limits;
  std::ifstream groups(root + "/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);)
    add_limits(line, root + "/sys/fs/cgroup", limits);
  return limits;
}

} // namespace vdbeam
