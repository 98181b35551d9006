#pragma once

#include "lights/light_set.h"
#include "transport/camera.h"
#include "transport/medium.h"
#include "volume/emission_grid.h"
#include "volume/vdb_reader.h"

#include <string>

namespace vdbeam {

/// A scene made ready for tracing: everything in render space. Immutable while rendering.
struct World {
  RenderSpace space;
  Medium medium;
  LightSet lights;
  OccupiedRegion region;
};

/// What the plan and the user are told about the volumes that a world was built from.
struct WorldFacts {
  struct Voxels {
    std::uint64_t density = 0;  ///< active voxels; 0: the volume is left out as empty
    std::uint64_t emission = 0; ///< active voxels of its emission grids; 0: it does not glow
  };
  std::vector<Voxels> volumes; ///< one per scene.volumes entry
  std::vector<std::string> notes;
};

/// Builds the world from the volumes' fields: one grid per scene.volumes entry; of emission as
/// many, or none at all. Throws InputError for lights that cannot be made. `facts`, unless it is
/// null, is filled.
World build_world(const Scene& scene, std::vector<DensityGrid> grids,
                  std::vector<EmissionGrid> emissions = {}, WorldFacts* facts = nullptr);

} // namespace vdbeam
