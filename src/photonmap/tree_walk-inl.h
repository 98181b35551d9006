// Walks the block tree, eight sibling boxes at a time. Included once per SIMD target.
#if defined(VDBEAM_TREE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VDBEAM_TREE_WALK_INL_H_
#undef VDBEAM_TREE_WALK_INL_H_
#else
#define VDBEAM_TREE_WALK_INL_H_
#endif

#include "photonmap/photon_blocks.h"

#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// `test(group)` gives a mask of the group's boxes that are hit; `visit(group index, group, mask)`
/// is called for groups of blocks. The order is fixed: depth first, low index first.
template <class Test, class Visit>
HWY_INLINE void walk_tree(const BlockTree& tree, const Test& test, const Visit& visit) {
  if (tree.levels.empty())
    return;
  struct Entry {
    std::uint32_t group;
    std::uint32_t mask;
  };
  Entry stack[BlockTree::max_levels];
  const int top = static_cast<int>(tree.levels.size()) - 1;
  int level = top;
  stack[level] = {0, test(tree.levels[level][0])};
  while (true) {
    Entry& entry = stack[level];
    if (level > 0 && entry.mask != 0) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(entry.mask));
      entry.mask &= entry.mask - 1;
      const std::uint32_t child = 8 * entry.group + slot;
      --level;
      stack[level] = {child, test(tree.levels[level][child])};
      continue;
    }
    if (level == 0 && entry.mask != 0)
      visit(entry.group, tree.levels[0][entry.group], entry.mask);
    if (level == top)
      return;
    ++level;
  }
}

/// Bits of `mask`, lane i of it being bit i.
template <class D>
HWY_INLINE std::uint32_t mask_bits(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}

using D8 = hn::CappedTag<float, 8>;

/// Mask of the boxes of a group that may hold a sphere which contains the point.
HWY_INLINE std::uint32_t boxes_around(const float* point, const BoxGroup& group) {
  const D8 d;
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    // Squared distance to the box of centres against the greatest radius.
    auto square = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto x = hn::Set(d, point[axis]);
      const auto below = hn::Sub(hn::Load(d, group.lower[axis] + lane), x);
      const auto above = hn::Sub(x, hn::Load(d, group.upper[axis] + lane));
      const auto outside = hn::Max(hn::Max(below, above), hn::Zero(d));
      square = hn::MulAdd(outside, outside, square);
    }
    const auto radius = hn::Load(d, group.radius + lane);
    const auto hit = hn::Le(square, hn::Mul(radius, radius));
    mask |= mask_bits(d, hit) << lane;
  }
  return mask;
}

/// `visit(block)` is called for the blocks that may hold a photon whose sphere contains the point.
template <class Visit>
HWY_INLINE void walk_around(const BlockTree& tree, const float* point, const Visit& visit) {
  walk_tree(
      tree, [&](const BoxGroup& group) HWY_ATTR { return boxes_around(point, group); },
      [&](std::uint32_t index, const BoxGroup&, std::uint32_t mask) HWY_ATTR {
        for (; mask != 0; mask &= mask - 1)
          visit(std::size_t{8 * index + static_cast<unsigned>(std::countr_zero(mask))});
      });
}

} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#endif
