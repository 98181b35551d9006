#pragma once

#include "vdbeam/render.h"

namespace vdbeam {

/// What the plan must know of each volume beyond the scene file.
struct VolumeFacts {
  bool empty = false;
  std::uint64_t active_voxels = 0;
};

/// The stages that the scene needs, each with the reason why it runs or is left out, and estimates
/// of the memory that they take. A pure function of its arguments.
RenderPlan plan_stages(const Scene& scene, const std::vector<VolumeFacts>& volumes);

} // namespace vdbeam
