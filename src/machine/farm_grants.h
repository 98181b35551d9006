#pragma once

#include <cstdint>

namespace vdbeam {

/// Grants of a farm engine to this process, from environment variables; 0 where they are not set or
/// not numbers.

/// Threads: the least of SLURM_CPUS_PER_TASK and CUE_THREADS.
int farm_threads();

/// Bytes: SLURM_MEM_PER_NODE, or SLURM_MEM_PER_CPU times SLURM_CPUS_ON_NODE; both in units of
/// 1024 * 1024 bytes (sbatch(1), "output environment variables").
std::uint64_t farm_memory();

} // namespace vdbeam
