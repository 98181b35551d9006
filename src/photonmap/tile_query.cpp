#include "photonmap/map_queries.h"
#include "photonmap/tile_bounds.h"
#include "photonmap/tile_frame.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photonmap/tile_query.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "photonmap/tile_shade-inl.h"
#include "photonmap/tree_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using D8 = hn::CappedTag<float, 8>;

/// A block that the tile reaches, with a bit for each sub-tile that may see it.
struct BlockHit {
  std::uint32_t block;
  std::uint32_t subtiles;
};

/// Which of eight nodes have spheres that touch the tile's frustum.
HWY_INLINE std::uint32_t boxes_in_frustum(const TileFrame& frame, const BoxGroup& group) {
  const D8 d;
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    hn::Vec<D8> lower[3], upper[3];
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] =
          hn::Sub(hn::Load(d, group.lower[axis] + lane), hn::Set(d, frame.reference[axis]));
      upper[axis] =
          hn::Sub(hn::Load(d, group.upper[axis] + lane), hn::Set(d, frame.reference[axis]));
    }
    const auto radius = hn::Load(d, group.radius + lane);
    auto hit = hn::Le(lower[0], upper[0]);
    for (const float* plane : frame.planes) {
      auto sum = hn::MulAdd(hn::Set(d, plane[4]), radius, hn::Set(d, plane[3]));
      for (int axis = 0; axis < 3; ++axis)
        sum =
            hn::MulAdd(hn::Set(d, plane[axis]), plane[axis] >= 0 ? upper[axis] : lower[axis], sum);
      hit = hn::And(hit, hn::Ge(sum, hn::Zero(d)));
    }
    mask |= mask_bits(d, hit) << lane;
  }
  return mask;
}

/// Which sub-tiles' pyramids the spheres of a block may touch.
HWY_INLINE std::uint32_t subtiles_of_box(const TileFrame& frame, const BoxGroup& group,
                                         std::uint32_t slot) {
  float center[3], half[3];
  const float radius = group.radius[slot];
  for (int axis = 0; axis < 3; ++axis) {
    center[axis] =
        (group.lower[axis][slot] + group.upper[axis][slot]) * 0.5f - frame.reference[axis];
    half[axis] = (group.upper[axis][slot] - group.lower[axis][slot]) * 0.5f;
  }
  float middle[3], extent[3];
  for (int i = 0; i < 3; ++i) {
    const float* axis = frame.axes[i];
    middle[i] = axis[0] * center[0] + axis[1] * center[1] + axis[2] * center[2];
    extent[i] = std::abs(axis[0]) * half[0] + std::abs(axis[1]) * half[1] +
                std::abs(axis[2]) * half[2] + frame.margin +
                radius * (i == 2 ? frame.depth_reach : frame.side_reach);
  }
  const D16 d;
  const float w = middle[2] + frame.camera_distance;
  const auto low = hn::Set(d, w - extent[2]), high = hn::Set(d, w + extent[2]);
  const auto u_low = hn::Set(d, middle[0] - extent[0]), u_high = hn::Set(d, middle[0] + extent[0]);
  const auto v_low = hn::Set(d, middle[1] - extent[1]), v_high = hn::Set(d, middle[1] + extent[1]);
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    // The depths that the box and the rays share; over them the rays keep to their linear bounds.
    const auto w0 = hn::Max(low, hn::Load(d, frame.w0 + lane));
    const auto w1 = hn::Min(high, hn::Load(d, frame.w1 + lane));
    auto hit = hn::Le(w0, w1);
    const auto overlap = [&](const float* slope0, const float* start0, const float* slope1,
                             const float* start1, hn::Vec<D16> from, hn::Vec<D16> to) HWY_ATTR {
      const auto t0 = hn::Load(d, slope0 + lane), t1 = hn::Load(d, slope1 + lane);
      const auto least =
          hn::Add(hn::Min(hn::Mul(t0, w0), hn::Mul(t0, w1)), hn::Load(d, start0 + lane));
      const auto most =
          hn::Add(hn::Max(hn::Mul(t1, w0), hn::Mul(t1, w1)), hn::Load(d, start1 + lane));
      hit = hn::And(hit, hn::And(hn::Ge(to, least), hn::Le(from, most)));
    };
    overlap(frame.a0, frame.u0, frame.a1, frame.u1, u_low, u_high);
    overlap(frame.b0, frame.v0, frame.b1, frame.v1, v_low, v_high);
    mask |= mask_bits(d, hit) << lane;
  }
  return (mask | frame.wide) & frame.active;
}

class TileWalk {
public:
  TileWalk(const MapView& map, const BeamTile& tile, const TileFrame& frame)
      : frame_(frame), query_(map.blocks, map.shape, tile),
        group_sums_(tile.by_group ? static_cast<std::size_t>(map.blocks.groups()) : 0) {
    for (int s = 0; s < BeamTile::subtile_count; ++s)
      if (frame.active >> s & 1)
        shaders_[s] = choose_shader(query_, frame.subtiles[s]);
  }

  void run(const BlockTree& tree) {
    walk_tree(
        tree, [&](const BoxGroup& group) HWY_ATTR { return boxes_in_frustum(frame_, group); },
        [&](std::uint32_t group_index, const BoxGroup& group, std::uint32_t mask) HWY_ATTR {
          for (; mask != 0; mask &= mask - 1) {
            const auto slot = static_cast<std::uint32_t>(std::countr_zero(mask));
            const std::uint32_t subtiles = subtiles_of_box(frame_, group, slot);
            if (subtiles == 0)
              continue;
            ++counts.blocks;
            prefetch_block(8 * group_index + slot);
            hits_[hit_count_++] = {8 * group_index + slot, subtiles};
            if (hit_count_ == hit_capacity)
              shade_hits();
          }
        });
    shade_hits();
  }

  void add_to(BeamTile& tile, int channels) {
    for (std::size_t g = 0; g < group_sums_.size(); ++g)
      add_group(tile, channels, g);
    for (int c = 0; c < channels; ++c)
      for (int r = 0; r < BeamTile::ray_count; ++r)
        if (frame_.active >> (r / BeamTile::rays_per_subtile) & 1)
          add_ray(tile, c, r);
  }

  QueryCounts counts;

private:
  static constexpr std::size_t hit_capacity = 64;

  void add_ray(BeamTile& tile, int channel, int ray) const {
    const auto at = static_cast<std::size_t>(channel * BeamTile::ray_count + ray);
    const float scale = frame_.subtiles[ray / 16].scale[ray % 16];
    if (!query_.blocks.has_first_flights()) {
      tile.radiance[at] += sums_[channel][ray] * scale;
      return;
    }
    const float first = -first_sums_[channel][ray] * scale; // of powers with a minus sign
    tile.first_flight[at] += first;
    tile.radiance[at] += sums_[channel][ray] * scale + first;
  }

  void prefetch_block(std::size_t block) const {
    const float* row = query_.blocks.row(block, 0);
    for (int field = 0; field <= PhotonBlocks::power; ++field)
      hwy::Prefetch(row + static_cast<std::size_t>(field) * PhotonBlocks::width);
  }

  /// Sub-tile by sub-tile, so that its weights and sums stay near.
  void shade_hits() {
    for (std::size_t s = 0; s < BeamTile::subtile_count; ++s) {
      const SubtileFrame& subtile = frame_.subtiles[s];
      for (std::size_t h = 0; h < hit_count_; ++h) {
        if (!(hits_[h].subtiles >> s & 1))
          continue;
        gather_candidates(query_, frame_.reference, subtile, hits_[h].block, candidates_);
        if (candidates_.count + PhotonBlocks::width > Candidates::capacity)
          shade_candidates(s);
      }
      shade_candidates(s);
    }
    hit_count_ = 0;
  }

  /// Adds one light group; all sums are those of the groups then.
  void add_group(BeamTile& tile, int channels, std::size_t group) {
    const GroupSums& own = group_sums_[group];
    for (int c = 0; c < channels; ++c)
      for (int r = 0; r < BeamTile::ray_count; ++r) {
        if (!(frame_.active >> (r / BeamTile::rays_per_subtile) & 1))
          continue;
        sums_[c][r] += own.rest[c][r];
        first_sums_[c][r] += own.first[c][r];
        const auto row = group * static_cast<std::size_t>(channels) + static_cast<std::size_t>(c);
        tile.group_radiance[row * BeamTile::ray_count + static_cast<std::size_t>(r)] +=
            (own.rest[c][r] - own.first[c][r]) * frame_.subtiles[r / 16].scale[r % 16];
      }
  }

  void shade_candidates(std::size_t s) {
    if (candidates_.count == 0)
      return;
    counts.candidates += candidates_.count * BeamTile::rays_per_subtile;
    if (group_sums_.empty())
      shade_selected(s, sums_, first_sums_, [](std::size_t) { return true; });
    for (std::size_t g = 0; g < group_sums_.size(); ++g)
      shade_selected(s, group_sums_[g].rest, group_sums_[g].first,
                     [&](std::size_t i) { return candidates_.group[i] == static_cast<float>(g); });
    candidates_.count = 0;
  }

  /// Shades the candidates i with wanted(i), those on their first flight apart.
  template <class Wanted>
  void shade_selected(std::size_t s, TileSums& sums, TileSums& first_sums, const Wanted& wanted) {
    rest_.count = first_.count = 0;
    const bool flights = query_.blocks.has_first_flights();
    for (std::size_t i = 0; i < candidates_.count; ++i) {
      const bool chosen = wanted(i);
      const bool first = flights && std::signbit(candidates_.signed_power[i]);
      rest_.index[rest_.count] = first_.index[first_.count] = static_cast<std::uint16_t>(i);
      rest_.count += chosen && !first;
      first_.count += chosen && first;
    }
    const SubtileFrame& subtile = frame_.subtiles[s];
    if (rest_.count > 0)
      counts.contributions += shaders_[s](query_, subtile, candidates_, rest_, s * 16, sums);
    if (first_.count > 0)
      counts.contributions += shaders_[s](query_, subtile, candidates_, first_, s * 16, first_sums);
  }

  /// Sums over the photons of one light group.
  struct GroupSums {
    alignas(64) TileSums rest = {};
    alignas(64) TileSums first = {}; ///< on their first flight
  };

  const TileFrame& frame_;
  TileQuery query_;
  Shader shaders_[BeamTile::subtile_count] = {};
  std::size_t hit_count_ = 0;
  BlockHit hits_[hit_capacity];
  Candidates candidates_;
  Selection rest_, first_; ///< candidates by kind, one sum for each
  alignas(64) TileSums sums_ = {};
  alignas(64) TileSums first_sums_ = {}; ///< of photons on their first flight
  std::vector<GroupSums> group_sums_;    ///< by group; empty where nobody asks
};

QueryCounts query_tile_on_target(const MapView& map, const TileFrame& frame, BeamTile& tile,
                                 int channels) {
  TileWalk walk(map, tile, frame);
  walk.run(map.tree);
  walk.add_to(tile, channels);
  return walk.counts;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbeam {

HWY_EXPORT(query_tile_on_target);

namespace {

/// A ray of a tile as a query of its own.
class TileRay {
public:
  TileRay(const BeamTile& tile, int ray) : tile_(tile), ray_(ray), d_(ray_direction(tile, ray)) {
    const BeamTile::Profile& knots = tile.profiles[ray / BeamTile::rays_per_subtile];
    weights_.resize(tile.rows() * static_cast<std::size_t>(knots.knots));
    for (std::size_t k = 0; k < weights_.size(); ++k)
      weights_[k] = tile.weights[knots.offset + k * BeamTile::rays_per_subtile +
                                 static_cast<std::size_t>(ray % BeamTile::rays_per_subtile)];
  }

  bool sees_anything() const {
    return is_live(d_) &&
           std::any_of(weights_.begin(), weights_.end(), [](float w) { return w != 0; });
  }
  PhotonMap::RayProfile profile() const {
    const BeamTile::Profile& knots = tile_.profiles[ray_ / BeamTile::rays_per_subtile];
    // From the first knot on, in double precision, since the lens may be far away.
    const Vec3d start =
        ray_start(tile_, ray_) - Vec3d{0, 0, tile_.camera_distance} + d_ * knots.t_begin;
    PhotonMap::RayProfile profile;
    profile.ray = {tile_.reference + Vec3f(in_render_space(start)), Vec3f(in_render_space(d_))};
    profile.step = knots.step;
    profile.knots = knots.knots;
    profile.t_end = static_cast<float>(tile_.end[static_cast<std::size_t>(ray_)] - knots.t_begin);
    profile.weights = weights_.data();
    profile.weight_channels = tile_.weight_channels;
    profile.phases = tile_.phases;
    return profile;
  }

private:
  Vec3d in_render_space(const Vec3d& v) const {
    return Vec3d(tile_.axis_u) * v.x + Vec3d(tile_.axis_v) * v.y + Vec3d(tile_.axis_w) * v.z;
  }

  const BeamTile& tile_;
  int ray_;
  Vec3d d_;
  std::vector<float> weights_;
};

/// Gathers a sub-tile ray by ray.
void query_rays(const MapView& map, BeamTile& tile, int subtile, int channels,
                QueryCounts& counts) {
  const int first = subtile * BeamTile::rays_per_subtile;
  for (int r = first; r < first + BeamTile::rays_per_subtile; ++r) {
    const TileRay ray(tile, r);
    if (!ray.sees_anything())
      continue;
    Rgb radiance, straight;
    const bool flights = map.blocks.has_first_flights();
    std::vector<Rgb> groups;
    counts += query_ray(map, ray.profile(), radiance, flights ? &straight : nullptr,
                        tile.by_group ? &groups : nullptr);
    for (int c = 0; c < channels; ++c) {
      const auto at = static_cast<std::size_t>(c * BeamTile::ray_count + r);
      tile.radiance[at] += radiance[c];
      if (flights)
        tile.first_flight[at] += straight[c];
      for (std::size_t g = 0; g < groups.size(); ++g)
        tile.group_radiance[g * static_cast<std::size_t>(channels) * BeamTile::ray_count + at] +=
            groups[g][c];
    }
  }
}

} // namespace

QueryCounts query_tile(const MapView& map, BeamTile& tile) {
  const int channels = std::max(map.blocks.channels(), tile.weight_channels);
  const std::size_t size = static_cast<std::size_t>(channels) * BeamTile::ray_count;
  if (tile.radiance.size() < size)
    tile.radiance.resize(size, 0.0f);
  if (map.blocks.has_first_flights() && tile.first_flight.size() < size)
    tile.first_flight.resize(size, 0.0f);
  const std::size_t groups = tile.by_group ? static_cast<std::size_t>(map.blocks.groups()) : 0;
  if (tile.group_radiance.size() < groups * size)
    tile.group_radiance.resize(groups * size, 0.0f);
  if (map.tree.levels.empty())
    return {};
  const Vec3f far_side =
      max(map.tree.bounds.upper - tile.reference, tile.reference - map.tree.bounds.lower);
  TileFrame frame;
  make_tile_frame(tile, map.mean_radius, length(max(far_side, Vec3f(0))),
                  map.blocks.has_directions(), frame);
  QueryCounts counts;
  if (frame.active != 0)
    counts = HWY_DYNAMIC_DISPATCH(query_tile_on_target)(map, frame, tile, channels);
  for (int s = 0; s < BeamTile::subtile_count; ++s)
    if (frame.subtiles[s].single)
      query_rays(map, tile, s, channels, counts);
  return counts;
}

} // namespace vdbeam
#endif
