#pragma once

#include <cstdint>

namespace vdbeam {

/// Bytes that this machine grants the process: its memory, or less where a control group, the farm
/// (SLURM_MEM_PER_NODE, SLURM_MEM_PER_CPU) or a limit on the address space says so.
std::uint64_t granted_memory();

/// Bytes that the process may still take: the least of what the machine has free (MemAvailable of
/// /proc/meminfo) and of what each of these grants leaves beside the memory in use. Whatever reads
/// a file is bounded by this.
std::uint64_t free_memory();

/// Returns the most memory that the process has held at once so far [bytes].
std::uint64_t peak_memory();

/// Gives back to the system what was freed and the C library still holds: after steps that take
/// much and leave little, which would count as taken until the process ends.
void return_freed_memory();

} // namespace vdbeam
