#pragma once

#include <openvdb/openvdb.h>

#include <vector>

namespace vdbeam {

using Grids = std::vector<openvdb::GridBase::Ptr>;

/// A ball and its velocity (1, 2, 3) in one staggered grid, as Mantaflow writes it.
Grids staggered(const openvdb::FloatGrid::Ptr& ball);

/// The same with the velocity in three grids of numbers, as some of Houdini's files have it.
Grids components(const openvdb::FloatGrid::Ptr& ball);

/// The same as `staggered`, with all that goes wrong in simulations in a third of the velocity's
/// voxels: not numbers, infinities, and 1e6.
Grids wild(const openvdb::FloatGrid::Ptr& ball);

/// A cloud, and a velocity in a box around it that turns, shears and lifts it: (-y, x + z / 2, x /
/// 2) at the point (x, y, z) of the world.
Grids whirl(const openvdb::FloatGrid::Ptr& cloud, const openvdb::CoordBBox& box);

} // namespace vdbeam
