#pragma once

#include <openvdb/openvdb.h>

#include <functional>
#include <vector>

namespace vdbeam {

/// Values below this part of the largest density are left out of a cloud.
inline constexpr float least_part = 0.004f;

/// Makes a half-float grid of voxels of the size `voxel` from a formula, leaf by leaf on all
/// threads. `value(world, leaf)` is the density at a voxel of the leaf number `leaf` in `leaves`,
/// which are the leaves' lower corners; values below `least` stay out of the grid. A leaf whose
/// voxels are all the same becomes a tile.
openvdb::FloatGrid::Ptr
fill_leaves(float voxel, const std::vector<openvdb::Coord>& leaves, float least,
            const std::function<float(const openvdb::Vec3f& world, std::size_t leaf)>& value);

} // namespace vdbeam
