#pragma once

#include "vdbeam/scene.h"

namespace vdbeam {

/// Threads to render with: render.threads, or else the least of what the machine has, what the
/// process may use of it (affinity, cgroup), and what a farm engine granted (SLURM_CPUS_PER_TASK,
/// CUE_THREADS).
int thread_count(const RenderSettings& settings);

} // namespace vdbeam
