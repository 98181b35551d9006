#pragma once

#include <cstdint>

namespace vdbeam {

/// What a farm engine granted this process by its environment; 0 where nothing is said. Values that
/// are no numbers count as not said.

/// Threads: the least of SLURM_CPUS_PER_TASK and CUE_THREADS.
int farm_threads();

/// Bytes: SLURM_MEM_PER_NODE, or SLURM_MEM_PER_CPU times SLURM_CPUS_ON_NODE; both in units of
/// 1024 * 1024 bytes (sbatch(1), "output environment variables").
std::uint64_t farm_memory();

} // namespace vdbeam
