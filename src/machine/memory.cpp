#include "machine/memory.h"

#include "machine/cgroups.h"
#include "machine/farm_grants.h"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace vdbeam {
namespace {

constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

std::uint64_t page_size() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

/// The memory of control groups and farms, which both count what is resident.
std::uint64_t resident_limit() {
  std::uint64_t bytes = no_limit;
  for (const std::uint64_t limit : {cgroup_limits().memory, farm_memory()})
    if (limit > 0)
      bytes = std::min(bytes, limit);
  return bytes;
}

std::uint64_t address_space_limit() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY ? limit.rlim_cur
                                                                                : no_limit;
}

struct MemoryInUse {
  std::uint64_t address_space = 0, resident = 0; ///< bytes
};

MemoryInUse memory_in_use() {
  std::ifstream file("/proc/self/statm");
  MemoryInUse pages;
  file >> pages.address_space >> pages.resident;
  return {pages.address_space * page_size(), pages.resident * page_size()};
}

/// MemAvailable; all memory where the system does not say.
std::uint64_t available_on_the_machine() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  for (std::uint64_t kibibytes = 0; file >> word;)
    if (word == "MemAvailable:" && file >> kibibytes)
      return kibibytes * 1024;
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * page_size();
}

std::uint64_t left(std::uint64_t limit, std::uint64_t used) {
  return limit == no_limit ? no_limit : limit - std::min(limit, used);
}

} // namespace

std::uint64_t granted_memory() {
  const std::uint64_t physical =
      static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * page_size();
  return std::min({physical, resident_limit(), address_space_limit()});
}

std::uint64_t free_memory() {
  const MemoryInUse used = memory_in_use();
  return std::min({available_on_the_machine(), left(resident_limit(), used.resident),
                   left(address_space_limit(), used.address_space)});
}

std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

void return_freed_memory() {
  malloc_trim(0);
}

} // namespace vdbeam
