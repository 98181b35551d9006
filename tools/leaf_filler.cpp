#include "leaf_filler.h"

#include <tbb/parallel_for.h>

#include <memory>

namespace vdbeam {

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3f;

openvdb::FloatGrid::Ptr
fill_leaves(float voxel, const std::vector<Coord>& leaves, float least,
            const std::function<float(const Vec3f& world, std::size_t leaf)>& value) {
  using Leaf = FloatGrid::TreeType::LeafNodeType;
  std::vector<std::unique_ptr<Leaf>> filled(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    auto leaf = std::make_unique<Leaf>(leaves[i], 0.0f, false);
    bool empty = true;
    for (openvdb::Index at = 0; at < Leaf::SIZE; ++at) {
      const Coord c = leaf->offsetToGlobalCoord(at);
      const float v = value(Vec3f(c.asVec3s()) * voxel, i);
      if (v < least)
        continue;
      leaf->setValueOn(at, v);
      empty = false;
    }
    if (!empty)
      filled[i] = std::move(leaf);
  });
  FloatGrid::Ptr grid = FloatGrid::create(0);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setSaveFloatAsHalf(true);
  for (std::unique_ptr<Leaf>& leaf : filled) {
    if (!leaf)
      continue;
    float same = 0;
    bool active = false;
    if (leaf->isConstant(same, active))
      grid->tree().addTile(1, leaf->origin(), same, active);
    else
      grid->tree().addLeaf(leaf.release());
  }
  return grid;
}

} // namespace vdbeam
