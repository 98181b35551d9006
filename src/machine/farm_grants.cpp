#include "machine/farm_grants.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <string_view>

namespace vdbeam {
namespace {

/// A whole number from the environment; 0 where it is missing, negative or anything else.
std::uint64_t variable(const char* name) {
  const char* text = std::getenv(name);
  if (!text)
    return 0;
  const std::string_view value(text);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  return error == std::errc{} && end == value.data() + value.size() ? number : 0;
}

} // namespace

int farm_threads() {
  std::uint64_t threads = 0;
  for (const char* name : {"SLURM_CPUS_PER_TASK", "CUE_THREADS"})
    if (const std::uint64_t granted = variable(name); granted > 0)
      threads = threads > 0 ? std::min(threads, granted) : granted;
  return static_cast<int>(std::min<std::uint64_t>(threads, std::numeric_limits<int>::max()));
}

std::uint64_t farm_memory() {
  std::uint64_t megabytes = variable("SLURM_MEM_PER_NODE");
  if (megabytes == 0)
    megabytes = variable("SLURM_MEM_PER_CPU") * variable("SLURM_CPUS_ON_NODE");
  return std::min(megabytes, std::uint64_t{1} << 40) << 20;
}

} // namespace vdbeam
