#include "photonmap/cell_radii.h"

#include "math/ray.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photonmap/cell_radii.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "photonmap/tree_walk-inl.h"

#ifndef VDBEAM_CELL_RADII_ONCE_
#define VDBEAM_CELL_RADII_ONCE_
namespace vdbeam {
namespace {

/// Cells as balls: centroid, radius of the ball of the cell's volume, photons.
struct Cells {
  std::vector<Vec3f> centre;
  std::vector<float> radius, mass;
  BlockTree tree;
  float wanted_mass = 0; ///< of the balls that are sought
};

/// Cells near a batch of eight, structure of arrays, padded to a multiple of 16 without mass.
struct NearCells {
  static constexpr std::size_t capacity = 2048;
  std::size_t count = 0;
  alignas(64) float x[capacity + 16], y[capacity + 16], z[capacity + 16];
  alignas(64) float radius[capacity + 16], mass[capacity + 16];
  alignas(64) float enter[capacity + 16], rate[capacity + 16]; ///< of the query at hand
};

} // namespace
} // namespace vdbeam
#endif

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D8 = hn::CappedTag<float, 8>;
using D16 = hn::CappedTag<float, 16>;

/// Nodes of `group` within `reach` of `box`.
HWY_INLINE std::uint32_t boxes_within(const Boxf& box, float reach, const BoxGroup& group) {
  const D8 d;
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    auto square = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto below =
          hn::Sub(hn::Load(d, group.lower[axis] + lane), hn::Set(d, box.upper[axis]));
      const auto above =
          hn::Sub(hn::Set(d, box.lower[axis]), hn::Load(d, group.upper[axis] + lane));
      const auto gap = hn::Max(hn::Max(below, above), hn::Zero(d));
      square = hn::MulAdd(gap, gap, square);
    }
    mask |= mask_bits(d, hn::Le(square, hn::Set(d, reach * reach))) << lane;
  }
  return mask;
}

/// All cells within `reach` of `box`; false where they are too many.
HWY_INLINE bool gather_near(const Cells& cells, const Boxf& box, float reach, NearCells& near) {
  near.count = 0;
  bool fits = true;
  walk_tree(
      cells.tree,
      [&](const BoxGroup& group) HWY_ATTR { return fits ? boxes_within(box, reach, group) : 0; },
      [&](std::uint32_t index, const BoxGroup&, std::uint32_t mask) HWY_ATTR {
        for (; mask != 0; mask &= mask - 1) {
          if (near.count == NearCells::capacity) {
            fits = false;
            return;
          }
          const std::size_t cell = 8 * index + static_cast<unsigned>(std::countr_zero(mask));
          const std::size_t i = near.count++;
          near.x[i] = cells.centre[cell].x;
          near.y[i] = cells.centre[cell].y;
          near.z[i] = cells.centre[cell].z;
          near.radius[i] = cells.radius[cell];
          near.mass[i] = cells.mass[cell];
        }
      });
  for (std::size_t i = near.count; i < (near.count + 15) / 16 * 16; ++i)
    near.x[i] = near.y[i] = near.z[i] = near.radius[i] = near.mass[i] = 0;
  return fits;
}

/// Where a growing ball about `centre` enters each near cell, and the mass per length inside it.
HWY_INLINE void prepare(const Vec3f& centre, float floor, NearCells& near) {
  const D16 d;
  for (std::size_t i = 0; i < near.count; i += hn::Lanes(d)) {
    const auto x = hn::Sub(hn::Load(d, near.x + i), hn::Set(d, centre.x));
    const auto y = hn::Sub(hn::Load(d, near.y + i), hn::Set(d, centre.y));
    const auto z = hn::Sub(hn::Load(d, near.z + i), hn::Set(d, centre.z));
    const auto radius = hn::Max(hn::Load(d, near.radius + i), hn::Set(d, floor));
    // Distances of a ball's points from `centre`, as a uniform spread of the same mean and
    // variance: mean 3/4 and variance 3/80 of the ball's radius about its own centre; far away mean
    // square d^2 + 2/5 and variance 1/5.
    const auto square = hn::Mul(radius, radius);
    const auto distance2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    const auto inner = hn::Div(hn::Mul(hn::Set(d, 0.1625f), square),
                               hn::MulAdd(hn::Set(d, 2.0f), distance2, square));
    const auto mean = hn::Sqrt(hn::MulAdd(hn::Add(inner, hn::Set(d, 0.4f)), square, distance2));
    const auto half =
        hn::Mul(hn::Sqrt(hn::NegMulAdd(hn::Set(d, 3.0f), inner, hn::Set(d, 0.6f))), radius);
    const auto enter = hn::Max(hn::Sub(mean, half), hn::Zero(d));
    const auto leave = hn::Add(mean, half);
    hn::Store(enter, d, near.enter + i);
    hn::Store(hn::Div(hn::Load(d, near.mass + i), hn::Sub(leave, enter)), d, near.rate + i);
  }
}

/// Mass of the ball of radius r; the sum's order is the same on every target.
HWY_INLINE float ball_mass(const NearCells& near, float r) {
  const D16 d;
  constexpr std::size_t parts = 16 / hn::MaxLanes(D16());
  hn::Vec<D16> sums[parts];
  for (auto& sum : sums)
    sum = hn::Zero(d);
  for (std::size_t i = 0; i < near.count; i += 16)
    for (std::size_t p = 0; p < parts; ++p) {
      const std::size_t at = i + p * hn::Lanes(d);
      const auto past = hn::Max(hn::Sub(hn::Set(d, r), hn::Load(d, near.enter + at)), hn::Zero(d));
      sums[p] = hn::Add(sums[p], hn::Min(hn::Mul(past, hn::Load(d, near.rate + at)),
                                         hn::Load(d, near.mass + at)));
    }
  alignas(64) float lanes[16];
  for (std::size_t p = 0; p < parts; ++p)
    hn::Store(sums[p], d, lanes + p * hn::Lanes(d));
  float total = 0;
  for (const float lane : lanes)
    total += lane;
  return total;
}

/// Radius in [0, reach] at which the ball's mass is `mass`, known to be reached there. Secants in
/// the cube of the radius, kept in a bracket.
HWY_INLINE float solve_radius(const NearCells& near, float mass, float reach, float mass_at_reach) {
  float r0 = 0, m0 = 0, r1 = reach, m1 = mass_at_reach;
  float r = reach * std::cbrt(mass / mass_at_reach);
  for (int step = 0; step < 12; ++step) {
    const float m = ball_mass(near, r);
    if (std::abs(m - mass) <= 2e-3f * mass)
      break;
    (m < mass ? r0 : r1) = r;
    (m < mass ? m0 : m1) = m;
    const float c0 = r0 * r0 * r0, c1 = r1 * r1 * r1;
    const float guess = std::cbrt(c0 + (c1 - c0) * ((mass - m0) / std::max(m1 - m0, 1e-6f * mass)));
    r = guess > r0 && guess < r1 ? guess : 0.5f * (r0 + r1);
  }
  return r;
}

/// Eight cells of one group, and how far around them to look.
struct Batch {
  std::size_t first, last;
  Boxf box;
  float reach;
};

Batch make_batch(const Cells& cells, std::size_t group) {
  Batch batch{8 * group, std::min(8 * group + 8, cells.centre.size()), {}, 0};
  float mass = 0, volume = 0;
  for (std::size_t cell = batch.first; cell < batch.last; ++cell) {
    batch.box.extend(cells.centre[cell]);
    mass += cells.mass[cell];
    volume += std::pow(cells.radius[cell], 3.0f);
  }
  batch.reach = 1.3f * std::cbrt(volume * cells.wanted_mass / mass);
  return batch;
}

/// Radii of the cells of one group: looks around them until all balls hold enough, or until there
/// is no more to see.
void solve_batch(const Cells& cells, std::size_t group, NearCells& near, float* radii) {
  const Batch batch = make_batch(cells, group);
  const float widest = std::max(length(cells.tree.bounds.size()), 1e-8f), floor = 1e-7f * widest;
  float reach = std::max(batch.reach, 2 * floor), too_small = 0, too_great = 1e30f;
  std::uint32_t open = (1u << (batch.last - batch.first)) - 1;
  for (std::size_t cell = batch.first; cell < batch.last; ++cell)
    radii[cell] = 0;
  while (open != 0) {
    if (gather_near(cells, batch.box, reach, near)) {
      for (std::size_t cell = batch.first; cell < batch.last; ++cell) {
        if (!(open >> (cell - batch.first) & 1))
          continue;
        prepare(cells.centre[cell], floor, near);
        const float mass = ball_mass(near, reach);
        radii[cell] = reach;
        if (mass >= cells.wanted_mass) {
          radii[cell] = solve_radius(near, cells.wanted_mass, reach, mass);
          open &= ~(1u << (cell - batch.first));
        }
      }
      too_small = reach;
    } else {
      too_great = reach;
    }
    // Past a cluster that is too rich to look at, the bracket closes on its distance.
    if (reach > 2 * widest || too_great < 1.1f * too_small || too_great <= 2 * floor)
      return;
    if (too_great > 1e29f)
      reach *= 1.6f;
    else
      reach = too_small > 0 ? std::sqrt(too_small * too_great) : 0.5f * reach;
  }
}

void solve_batches(const Cells& cells, std::size_t begin, std::size_t end, NearCells& near,
                   float* radii) {
  for (std::size_t group = begin; group < end; ++group)
    solve_batch(cells, group, near, radii);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbeam {

HWY_EXPORT(solve_batches);

namespace {

Cells make_cells(const PhotonBlocks& blocks, std::size_t blocks_per_cell) {
  Cells cells;
  cells.tree = build_cell_tree(blocks, blocks_per_cell);
  const std::size_t width = blocks_per_cell * PhotonBlocks::width;
  const std::size_t count = (blocks.count() + width - 1) / width;
  cells.centre.resize(count);
  cells.radius.resize(count);
  cells.mass.resize(count);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t cell) {
    Vec3d sum;
    const std::size_t begin = cell * width, end = std::min(blocks.count(), begin + width);
    for (std::size_t i = begin; i < end; ++i)
      sum += Vec3d(blocks.position(i));
    const auto mass = static_cast<float>(end - begin);
    cells.centre[cell] = Vec3f(sum / static_cast<double>(end - begin));
    cells.mass[cell] = mass;
    // A ball of radius R has mean square 3/5 R^2 about its centre; n points about their own mean
    // have (n - 1) / n of it.
    double square = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f offset = blocks.position(i) - cells.centre[cell];
      square += static_cast<double>(dot(offset, offset));
    }
    cells.radius[cell] =
        static_cast<float>(std::sqrt(square / std::max<double>(mass - 1, 1) * 5 / 3));
  });
  return cells;
}

} // namespace

std::vector<float> find_cell_radii(const PhotonBlocks& blocks, std::size_t blocks_per_cell,
                                   float neighbours) {
  Cells cells = make_cells(blocks, blocks_per_cell);
  // Where the set has fewer photons than are asked for, the ball that holds most of them is scaled.
  const float all = 0.9f * static_cast<float>(blocks.count());
  cells.wanted_mass = std::min(neighbours, all);
  const float growth = std::cbrt(neighbours / std::max(cells.wanted_mass, 1e-3f));
  std::vector<float> radii(cells.centre.size());
  if (radii.empty())
    return radii;
  tbb::enumerable_thread_specific<NearCells> near;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cells.tree.levels[0].size(), 4),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      HWY_DYNAMIC_DISPATCH(solve_batches)
                      (cells, range.begin(), range.end(), near.local(), radii.data());
                    });
  for (float& radius : radii)
    radius *= growth;
  return radii;
}

} // namespace vdbeam
#endif
