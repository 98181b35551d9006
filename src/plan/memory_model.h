#pragma once

#include "vdb/grid_shape.h"
#include "vdbeam/memory_plan.h"

namespace vdbeam {

/// The bytes times a factor, in whole bytes.
inline std::uint64_t times(double factor, std::uint64_t bytes) {
  return static_cast<std::uint64_t>(factor * static_cast<double>(bytes));
}

/// Where a volume is that the camera may see.
struct SeenCells {
  CellSet cells;
  Affine to_world;   ///< of the cells
  bool dims = false; ///< light: it absorbs or scatters
};

/// Memory of the volumes of a scene.
struct VolumesMemory {
  std::uint64_t kept = 0;    ///< while the frame is rendered, all moments of its shutter included
  std::uint64_t still = 0;   ///< without the moments
  std::uint64_t reading = 0; ///< the most beside it while they are read and prepared
  std::uint64_t moments = 0; ///< of its shutter that are kept; 0: nothing moves
  std::uint64_t cells = 0;   ///< entries of the index tables
  std::string largest, why;  ///< the file that needs most, and what in the scene asks for it
  std::vector<SeenCells> seen;
  /// Optical depth of the medium along a ray that meets it, the mean over such rays; below 0: not
  /// known.
  double depth = 0;
};

/// Estimates it from the topology of the files' trees. Throws as read_density_grid.
VolumesMemory estimate_volumes(const Scene& scene);

/// Estimates the memory that a frame of this plan takes. `references`: the number of reference
/// images that it is compared with.
MemoryPlan estimate_memory(const Scene& scene, const RenderPlan& plan, const VolumesMemory& volumes,
                           int references);

} // namespace vdbeam
