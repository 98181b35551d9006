#pragma once

#include "vdb/grid_shape.h"
#include "vdbeam/memory_plan.h"

namespace vdbeam {

/// What the volumes of a scene take.
struct VolumesMemory {
  std::uint64_t kept = 0;    ///< while the frame is rendered, all moments of its shutter included
  std::uint64_t still = 0;   ///< without the moments
  std::uint64_t reading = 0; ///< the most beside it while they are read and prepared
  std::uint64_t cells = 0;   ///< entries of the index tables
  std::string largest, why;  ///< the file that needs most, and what in the scene asks for it
  std::vector<CellSet> sets; ///< of what the camera sees, with
  std::vector<Affine> to_world; ///< the place of their cells
};

/// Estimates it from the topology of the files' trees. Throws as read_density_grid.
VolumesMemory estimate_volumes(const Scene& scene);

/// The memory of a frame of this plan whose volumes take so much.
MemoryPlan estimate_memory(const Scene& scene, const RenderPlan& plan,
                           const VolumesMemory& volumes);

} // namespace vdbeam
