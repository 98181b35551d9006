#include "photonmap/photon_blocks.h"

#include <tbb/parallel_for.h>

namespace vdbeam {
namespace {

/// Outwards by more than the rounding of the tests that use the box.
constexpr float box_rounding = 4e-7f;

struct Bounds {
  Boxf centres;
  float radius = 0;
};

Bounds bound_blocks(const PhotonBlocks& blocks, std::size_t begin, std::size_t end) {
  Bounds bounds;
  for (std::size_t block = begin; block < end; ++block) {
    const std::size_t in_block =
        std::min(PhotonBlocks::width, blocks.count() - block * PhotonBlocks::width);
    for (int axis = 0; axis < 3; ++axis) {
      const float* position = blocks.row(block, axis);
      for (std::size_t i = 0; i < in_block; ++i) {
        const float margin = std::abs(position[i]) * box_rounding;
        bounds.centres.lower[axis] = std::min(bounds.centres.lower[axis], position[i] - margin);
        bounds.centres.upper[axis] = std::max(bounds.centres.upper[axis], position[i] + margin);
      }
    }
    const float* radius = blocks.row(block, PhotonBlocks::radius);
    bounds.radius = std::max(bounds.radius, *std::max_element(radius, radius + in_block));
  }
  bounds.radius *= 1 + box_rounding;
  return bounds;
}

Bounds bound_group(const BoxGroup& group) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.centres.lower[axis] = *std::min_element(group.lower[axis], group.lower[axis] + 8);
    bounds.centres.upper[axis] = *std::max_element(group.upper[axis], group.upper[axis] + 8);
  }
  bounds.radius = *std::max_element(group.radius, group.radius + 8);
  return bounds;
}

void set_slot(const Bounds& bounds, BoxGroup& group, std::size_t slot) {
  for (int axis = 0; axis < 3; ++axis) {
    group.lower[axis][slot] = bounds.centres.lower[axis];
    group.upper[axis][slot] = bounds.centres.upper[axis];
  }
  group.radius[slot] = bounds.radius;
}

/// `bound_leaf(i)`: the bounds of the i-th of `leaves`.
template <class BoundLeaf>
BlockTree build_tree(std::size_t leaves, const BoundLeaf& bound_leaf) {
  BlockTree tree;
  std::size_t children = leaves;
  while (children > 0) {
    const std::size_t groups = (children + 7) / 8;
    auto& level = tree.levels.emplace_back(groups);
    const auto* below = tree.levels.size() > 1 ? &tree.levels[tree.levels.size() - 2] : nullptr;
    tbb::parallel_for(std::size_t(0), groups, [&](std::size_t g) {
      for (std::size_t slot = 0; slot < 8; ++slot) {
        const std::size_t child = 8 * g + slot;
        if (child >= children)
          set_slot({}, level[g], slot);
        else
          set_slot(below ? bound_group((*below)[child]) : bound_leaf(child), level[g], slot);
      }
    });
    children = groups == 1 ? 0 : groups;
  }
  if (!tree.levels.empty()) {
    const Bounds all = bound_group(tree.levels.back().front());
    tree.bounds.lower = all.centres.lower - Vec3f(all.radius);
    tree.bounds.upper = all.centres.upper + Vec3f(all.radius);
  }
  return tree;
}

} // namespace

BlockTree build_block_tree(const PhotonBlocks& blocks) {
  return build_tree(blocks.block_count(),
                    [&](std::size_t block) { return bound_blocks(blocks, block, block + 1); });
}

BlockTree build_cell_tree(const PhotonBlocks& blocks, std::size_t blocks_per_cell) {
  const std::size_t cells = (blocks.block_count() + blocks_per_cell - 1) / blocks_per_cell;
  return build_tree(cells, [&](std::size_t cell) {
    Bounds bounds = bound_blocks(blocks, cell * blocks_per_cell,
                                 std::min(blocks.block_count(), (cell + 1) * blocks_per_cell));
    bounds.radius = 0;
    return bounds;
  });
}

} // namespace vdbeam
