#pragma once

#include "vdbeam/memory_plan.h"
#include "vdbeam/render.h"

#include <optional>

namespace vdbeam {

/// Throws InputError where the samples of a deep picture need more than `granted` bytes.
void check_deep_memory(const Scene& scene, std::uint64_t bytes, std::uint64_t granted);

/// Result of plan_memory; empty where a bound by the sizes of the frame's files shows that it
/// takes less than half of `granted`, or where its files cannot be read.
std::optional<MemoryPlan> plan_large_frame(const Scene& scene, int references,
                                           std::uint64_t granted);

/// Throws InputError, with what needs most and a remedy, where the planned peak is more than
/// `granted` bytes.
void check_planned_memory(const Scene& scene, const MemoryPlan& plan, std::uint64_t granted);

/// Throws InputError, with what it would take and a remedy, where the photons of a pass or the
/// picture need more than `granted` bytes. What is merely large is left to the machine.
void check_memory(const Scene& scene, const RenderPlan& plan, std::uint64_t granted);

} // namespace vdbeam
