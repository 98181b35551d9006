#pragma once

#include "photonmap/photon_blocks.h"
#include "photonmap/photon_map.h"

#include <cstdint>
#include <vector>

namespace vdbeam {

/// Data of a map that the SIMD queries need.
struct MapView {
  const PhotonBlocks& blocks;
  const BlockTree& tree;
  KernelShape shape;
  float mean_radius;
};

/// PhotonMap::query, query_ray and query_point on the best SIMD target of this machine.
QueryCounts query_tile(const MapView& map, BeamTile& tile);
/// `first_flight`, unless it is null, takes the part of photons on their first flight too, and
/// `groups` the parts of groups of lights, as PhotonMap has them.
QueryCounts query_ray(const MapView& map, const PhotonMap::RayProfile& profile, Rgb& radiance,
                      Rgb* first_flight = nullptr, std::vector<Rgb>* groups = nullptr);
QueryCounts query_point(const MapView& map, const Vec3f& point, const Vec3f& direction,
                        const std::vector<PhaseFunction>& phases, Rgb* in_scattered,
                        Rgb* first_flight = nullptr, std::vector<Rgb>* groups = nullptr);
/// Adds the numbers of the photons whose spheres contain the point, in a fixed order.
void find_around(const MapView& map, const Vec3f& point, std::vector<std::size_t>& found);

/// SIMD targets that this binary has and this machine can run, best first, as Highway's bits; and a
/// way to confine the queries to some of them (0: all), for tests.
std::vector<std::int64_t> simd_targets();
void confine_simd_targets(std::int64_t targets);
/// Whether the target that queries run on has a fused multiply-add. All that have one give the same
/// bits.
bool simd_is_fused();

} // namespace vdbeam
