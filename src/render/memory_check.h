#pragma once

#include "vdbeam/render.h"

namespace vdbeam {

/// Throws InputError where the samples of a deep picture need more than `granted` bytes.
void check_deep_memory(const Scene& scene, std::uint64_t bytes, std::uint64_t granted);

/// Throws InputError, with what it would take and a remedy, where the photons of a pass or the
/// picture need more than `granted` bytes. What is merely large is left to the machine.
void check_memory(const Scene& scene, const RenderPlan& plan, std::uint64_t granted);

} // namespace vdbeam
