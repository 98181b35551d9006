#include "photonmap/map_queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photonmap/disc_query.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "photonmap/photon_math-inl.h"
#include "photonmap/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// Adds those of a block that contain the point; padding has no radius, so none of it does.
HWY_INLINE void find_in_block(const PhotonBlocks& blocks, std::size_t block, const float* point,
                              std::vector<std::size_t>& found) {
  const D16 d;
  for (std::size_t lane = 0; lane < PhotonBlocks::width; lane += hn::Lanes(d)) {
    auto square = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto e = hn::Sub(hn::Load(d, blocks.row(block, axis) + lane), hn::Set(d, point[axis]));
      square = hn::MulAdd(e, e, square);
    }
    const auto radius = hn::Load(d, blocks.row(block, PhotonBlocks::radius) + lane);
    for (std::uint32_t hit = mask_bits(d, hn::Lt(square, hn::Mul(radius, radius))); hit != 0;
         hit &= hit - 1)
      found.push_back(block * PhotonBlocks::width + lane +
                      static_cast<unsigned>(std::countr_zero(hit)));
  }
}

void around_on_target(const MapView& map, const Vec3f& point, std::vector<std::size_t>& found) {
  const float x[3] = {point.x, point.y, point.z};
  walk_around(map.tree, x,
              [&](std::size_t block) HWY_ATTR { find_in_block(map.blocks, block, x, found); });
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbeam {

HWY_EXPORT(around_on_target);

void find_around(const MapView& map, const Vec3f& point, std::vector<std::size_t>& found) {
  if (!map.tree.levels.empty())
    HWY_DYNAMIC_DISPATCH(around_on_target)(map, point, found);
}

} // namespace vdbeam
#endif
