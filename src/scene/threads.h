#pragma once

#include "vdbeam/scene.h"

#include <string>

namespace vdbeam {

/// Threads to render with: render.threads, or else the least of what the machine has, what the
/// process may use of it (affinity, cgroup), and what a farm engine granted (SLURM_CPUS_PER_TASK,
/// CUE_THREADS).
int thread_count(const RenderSettings& settings);

/// CPUs that a cgroup allows, rounded up; 0 for no limit. `text` is the content of cpu.max (version
/// 2: "max 100000", "150000 100000").
int cgroup_cpus(const std::string& text);

} // namespace vdbeam
