#pragma once

#include "photonmap/photon_blocks.h"

namespace vdbeam {

/// For each cell of `blocks_per_cell` consecutive blocks (in kd-median order): the radius of a ball
/// about its centroid that is expected to hold `neighbours` photons, 0 where they coincide.
///
/// The mass of a ball is summed over the cells near it, each cell is modelled as a ball of its own
/// volume whose mass is counted in linearly as the search ball grows over it; the result is as
/// smooth as that of an exact search, at a cost that does not grow with `neighbours` if cells hold
/// about a sixteenth of them.
std::vector<float> find_cell_radii(const PhotonBlocks& blocks, std::size_t blocks_per_cell,
                                   float neighbours);

} // namespace vdbeam
