#pragma once

#include "photonmap/photon_map.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// Gathers the photons of a tile once more, piece by piece of its pixels' deep layout, and adds
/// their light to image.deep. `tile` is as fill_beam_tile left it; its weights and radiance are
/// overwritten.
///
/// A table of weights is linear between knots: a sum of hats, one for each knot. Each hat is shared
/// out among the pieces of the ray that it overlaps, so the pieces' light adds up to that of the
/// whole ray, and is blurred by the length between two knots at most.
void gather_pieces(const World& world, const PhotonMap& map, const TileRays& rays, BeamTile& tile,
                   PassImage& image);

} // namespace vdbeam
