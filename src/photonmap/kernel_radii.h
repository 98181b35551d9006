#pragma once

#include "photonmap/photon_blocks.h"
#include "photonmap/photon_map.h"

namespace vdbeam {

/// Fills the radius field of every photon of `blocks` (in kd-median order). Adaptive radii are
/// those of a sphere that is expected to hold `settings.neighbours` photons.
void find_kernel_radii(PhotonBlocks& blocks, const RadiusSettings& settings);

} // namespace vdbeam
