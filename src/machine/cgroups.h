#pragma once

#include <cstdint>
#include <string>

namespace vdbeam {

/// Limits of this process' control groups; 0: no limit.
struct CgroupLimits {
  int cpus = 0;             ///< processors' worth of time, rounded up
  std::uint64_t memory = 0; ///< bytes
};

/// The least limits of this process' control groups and all above them, of version 2 and version 1,
/// as far as they can be seen: in a container, the container's. `root` is the folder that holds
/// proc and sys.
CgroupLimits cgroup_limits(const std::string& root = "");

} // namespace vdbeam
