#pragma once

#include "camera/camera.h"
#include "math/stop_token.h"
#include "transport/world.h"

namespace vdbeam {

/// Importance of each cell of the medium for the camera: the largest transmittance from the camera
/// to the cell along rays of the picture; it falls off by 1 / e per `reach` (render units) towards
/// cells that no ray sees. If `reach` is a kernel's radius, photons of low importance stay away
/// from the rays that see them well. Between `floor` and 1. A pure function of its arguments; adds
/// the number of traced rays to `rays`. Where `stop` asked to end meanwhile, cells are missing.
CellTables view_importance(const World& world, const Camera& camera, float reach, float floor,
                           std::uint64_t& rays, const StopToken* stop = nullptr);

} // namespace vdbeam
