#include "photonmap/photon_blocks.h"

#include <tbb/parallel_for.h>

namespace vdbeam {
namespace {

void clear_slot(BoxGroup& group, std::size_t slot) {
  for (int axis = 0; axis < 3; ++axis) {
    group.lower[axis][slot] = 1e30f;
    group.upper[axis][slot] = -1e30f;
  }
  group.radius[slot] = 0;
}

/// Outwards by more than the rounding of the tests that use the box.
constexpr float box_rounding = 4e-7f;

void bound_block(const PhotonBlocks& blocks, std::size_t block, BoxGroup& group, std::size_t slot) {
  const std::size_t in_block =
      std::min(PhotonBlocks::width, blocks.count() - block * PhotonBlocks::width);
  const float* radius = blocks.row(block, PhotonBlocks::radius);
  for (int axis = 0; axis < 3; ++axis) {
    const float* position = blocks.row(block, axis);
    float lower = 1e30f, upper = -1e30f;
    for (std::size_t i = 0; i < in_block; ++i) {
      const float margin = std::abs(position[i]) * box_rounding;
      lower = std::min(lower, position[i] - margin);
      upper = std::max(upper, position[i] + margin);
    }
    group.lower[axis][slot] = lower;
    group.upper[axis][slot] = upper;
  }
  group.radius[slot] = *std::max_element(radius, radius + in_block) * (1 + box_rounding);
}

void bound_group(const BoxGroup& child, BoxGroup& group, std::size_t slot) {
  for (int axis = 0; axis < 3; ++axis) {
    group.lower[axis][slot] = *std::min_element(child.lower[axis], child.lower[axis] + 8);
    group.upper[axis][slot] = *std::max_element(child.upper[axis], child.upper[axis] + 8);
  }
  group.radius[slot] = *std::max_element(child.radius, child.radius + 8);
}

} // namespace

BlockTree build_block_tree(const PhotonBlocks& blocks) {
  BlockTree tree;
  std::size_t children = blocks.block_count();
  while (children > 0) {
    const std::size_t groups = (children + 7) / 8;
    auto& level = tree.levels.emplace_back(groups);
    const auto* below = tree.levels.size() > 1 ? &tree.levels[tree.levels.size() - 2] : nullptr;
    tbb::parallel_for(std::size_t(0), groups, [&](std::size_t g) {
      for (std::size_t slot = 0; slot < 8; ++slot) {
        const std::size_t child = 8 * g + slot;
        if (child >= children)
          clear_slot(level[g], slot);
        else if (below)
          bound_group((*below)[child], level[g], slot);
        else
          bound_block(blocks, child, level[g], slot);
      }
    });
    children = groups == 1 ? 0 : groups;
  }
  if (!tree.levels.empty()) {
    BoxGroup root;
    bound_group(tree.levels.back().front(), root, 0);
    for (int axis = 0; axis < 3; ++axis) {
      tree.bounds.lower[axis] = root.lower[axis][0] - root.radius[0];
      tree.bounds.upper[axis] = root.upper[axis][0] + root.radius[0];
    }
  }
  return tree;
}

} // namespace vdbeam
