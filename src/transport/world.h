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
  RenderSettings settings;
  std::vector<std::string> notes;           ///< for the user
  std::vector<std::uint64_t> active_voxels; ///< per volume of the scene; 0: left out as empty
  std::vector<std::uint64_t>
      glowing_voxels; ///< per volume, of its emission grids; 0: does not glow
  double seconds_read = 0, seconds_build = 0;
};

/// Reads the volumes and builds the world. Throws InputError and FrameError.
World build_world(const Scene& scene);

/// The same from fields that are already there: one per scene.volumes entry; of emission as many,
/// or none at all.
World build_world(const Scene& scene, std::vector<DensityGrid> grids,
                  std::vector<EmissionGrid> emissions = {});

} // namespace vdbeam
