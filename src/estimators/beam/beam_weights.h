#pragma once

#include "photonmap/photon_map.h"
#include "rays/tile_rays.h"

namespace vdbeam {

/// How the rays of a tile weigh a photon at distance t.
struct WeightSettings {
  PhotonStore store = PhotonStore::fluence;
  bool albedo_in_power = true; ///< the photons carry the albedo that all volumes share
  bool colored = false;        ///< photons have a colour
  float reach = 0;             ///< scatter storage: how far beyond the medium photons are gathered
  /// Per volume of the medium, whether it counts; null: all do.
  const std::vector<std::uint8_t>* only = nullptr;
};

/// Fills the tile's frame, directions and weight tables from its rays.
///
/// Fluence storage: the mean of Tr sigma_s over each interval between knots is taken from exact
/// optical depths at its ends, (Tr(a) - Tr(b)) / (b - a) * albedo, and W at a knot is the mean of
/// the two intervals that it joins. So the table's integral is exact however stiff the medium, and
/// no voxel can be missed. Scatter storage: W = Tr.
///
/// A ray that ends at a surface has weights up to there that do not ramp down before it: the table
/// of one ray ends there, and the tile knows where each of its rays does.
void fill_beam_tile(const World& world, const Camera& camera, const TileRays& rays,
                    const WeightSettings& settings, BeamTile& tile);

/// The same for a single ray, whose profile is not empty, as PhotonMap::query_ray takes it: by part
/// of the medium. The result points into `weights`.
std::vector<PhotonMap::RayProfile> ray_weights(const World& world, const CameraRay& camera,
                                               const DepthProfile& profile,
                                               const WeightSettings& settings,
                                               std::vector<float>& weights);

} // namespace vdbeam
