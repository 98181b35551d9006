#pragma once

#include "transport/camera.h"
#include "transport/world.h"

namespace vdbeam {

/// How well the camera sees each cell of the medium: the largest transmittance from the camera to
/// the cell along rays of the picture, which falls off by 1 / e per `reach` (render units) to cells
/// that no ray sees. With a kernel's radius for `reach`, no photon of little importance lies under
/// a ray that sees it well. From `floor` to 1. A pure function of its arguments; adds to
/// `rays` those that it shot.
CellTables view_importance(const World& world, const Camera& camera, float reach, float floor,
                           std::uint64_t& rays);

} // namespace vdbeam
