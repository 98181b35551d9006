#include "photonmap/map_queries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "photonmap/ray_query.cpp"
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "photonmap/photon_math-inl.h"
#include "photonmap/tree_walk-inl.h"

#ifndef VDBEAM_RAY_QUERY_ONCE_
#define VDBEAM_RAY_QUERY_ONCE_
namespace vdbeam {
namespace {

/// A ray whose origin lies near the photons, so that single precision is enough.
struct NearRay {
  float origin[3], direction[3], inverse[3];
  float t_begin, t_end;
  float last;   ///< knot coordinate of its end
  float margin; ///< outward margin of the box tests [length]
};

NearRay near_ray(const PhotonMap::RayProfile& profile, const Boxf& bounds) {
  const Vec3d from(profile.ray.origin), direction = normalize(Vec3d(profile.ray.direction));
  const double shift = dot(Vec3d(bounds.center()) - from, direction);
  const Vec3d origin = from + direction * shift;
  NearRay ray;
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(origin[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
    ray.inverse[axis] = static_cast<float>(std::abs(direction[axis]) > 1e-12
                                               ? 1 / direction[axis]
                                               : std::copysign(1e12, direction[axis]));
  }
  ray.t_begin = static_cast<float>(profile.t_begin - shift);
  ray.t_end = static_cast<float>(profile.t_begin +
                                 static_cast<double>(profile.step) * (profile.knots - 1) - shift);
  ray.last = std::min(static_cast<float>(profile.knots - 1),
                      (profile.t_end - profile.t_begin) / profile.step);
  ray.margin = 1e-6f * (length(bounds.size()) + length(Vec3f(origin) - bounds.center()));
  return ray;
}

/// Sums of 16 lanes per channel, added up in one order on every SIMD target.
struct LaneSums {
  alignas(64) float lanes[3][16] = {};

  /// `grey`: the other channels are as the first.
  Rgb total(bool grey) const {
    Rgb sum(0);
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 16; ++i)
        sum[c] += lanes[c][i];
    return grey ? Rgb(sum.x) : sum;
  }
};

constexpr std::size_t phases_at_once = 4;

/// Sums by group of lights: [group][phases_at_once]; none where nobody asks.
using GroupSums = std::vector<LaneSums>;

} // namespace
} // namespace vdbeam
#endif

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

HWY_INLINE std::uint32_t boxes_on_ray(const NearRay& ray, const BoxGroup& group) {
  const D8 d;
  std::uint32_t mask = 0;
  for (std::size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    auto enter = hn::Set(d, ray.t_begin - ray.margin), leave = hn::Set(d, ray.t_end + ray.margin);
    const auto reach = hn::Add(hn::Load(d, group.radius + lane), hn::Set(d, ray.margin));
    for (int axis = 0; axis < 3; ++axis) {
      const auto inverse = hn::Set(d, ray.inverse[axis]), origin = hn::Set(d, ray.origin[axis]);
      const auto lower = hn::Sub(hn::Load(d, group.lower[axis] + lane), reach);
      const auto upper = hn::Add(hn::Load(d, group.upper[axis] + lane), reach);
      const auto t0 = hn::Mul(hn::Sub(lower, origin), inverse);
      const auto t1 = hn::Mul(hn::Sub(upper, origin), inverse);
      enter = hn::Max(enter, hn::Min(t0, t1));
      leave = hn::Min(leave, hn::Max(t0, t1));
    }
    // A missing box has its bounds crossed: it may pass the slabs, never this.
    const auto real =
        hn::Le(hn::Load(d, group.lower[0] + lane), hn::Load(d, group.upper[0] + lane));
    mask |= mask_bits(d, hn::And(real, hn::Le(enter, leave))) << lane;
  }
  return mask;
}

/// Sixteen photons of a block, or a part of them.
struct PhotonLanes {
  const PhotonBlocks& blocks;
  std::size_t block, lane;

  HWY_INLINE V16 field(int f) const { return hn::Load(D16(), blocks.row(block, f) + lane); }
  HWY_INLINE V16 cosine(const float* direction) const {
    const D16 d;
    const int df = blocks.direction_field();
    return hn::NegMulAdd(hn::Set(d, direction[0]), field(df),
                         hn::NegMulAdd(hn::Set(d, direction[1]), field(df + 1),
                                       hn::Mul(hn::Set(d, -direction[2]), field(df + 2))));
  }
  HWY_INLINE void add(V16 value, int channel, LaneSums& sums) const {
    add_power(value, hn::Abs(power(channel)), channel, sums);
  }
  /// The same for the photons of each group, in `phase`'s sums.
  HWY_INLINE void add_to_groups(V16 value, int channel, std::size_t phase, GroupSums& sums) const {
    const D16 d;
    if (sums.empty())
      return;
    const auto group = field(blocks.group_field());
    for (std::size_t g = 0; g < sums.size() / phases_at_once; ++g) {
      const auto mine = hn::Eq(group, hn::Set(d, static_cast<float>(g)));
      if (!hn::AllFalse(d, mine))
        add(hn::IfThenElseZero(mine, value), channel, sums[g * phases_at_once + phase]);
    }
  }
  /// The same for photons on their first flight, whose power has a minus sign.
  HWY_INLINE void add_first_flight(V16 value, int channel, LaneSums& sums) const {
    const D16 d;
    add_power(value, hn::Max(hn::Neg(power(channel)), hn::Zero(d)), channel, sums);
  }

private:
  HWY_INLINE V16 power(int channel) const {
    return field(PhotonBlocks::power + channel % blocks.channels());
  }
  HWY_INLINE void add_power(V16 value, V16 power, int channel, LaneSums& sums) const {
    const D16 d;
    float* sum = sums.lanes[channel] + lane;
    hn::Store(hn::MulAdd(value, power, hn::Load(d, sum)), d, sum);
  }
};

/// Phase function per lane; without stored directions the mean over all directions.
HWY_INLINE V16 phase_lanes(const PhotonLanes& photons, const PhaseFunction& phase,
                           const float* direction) {
  const D16 d;
  if (!photons.blocks.has_directions())
    return hn::Set(d, 1 / (4 * pi));
  return phase_value(d, phase, photons.cosine(direction));
}

class RayWalk {
public:
  RayWalk(const MapView& map, const PhotonMap::RayProfile& profile, const NearRay& ray,
          bool first_flights, GroupSums& groups)
      : group_sums(groups), map_(map), profile_(profile), ray_(ray),
        kernel_(disc_polynomial(map.shape)),
        channels_(std::max(map.blocks.channels(), profile.weight_channels)),
        first_flights_(first_flights && map.blocks.has_first_flights()) {}

  void run() {
    walk_tree(
        map_.tree, [&](const BoxGroup& group) HWY_ATTR { return boxes_on_ray(ray_, group); },
        [&](std::uint32_t index, const BoxGroup&, std::uint32_t mask) HWY_ATTR {
          for (std::uint32_t bits = mask; bits != 0; bits &= bits - 1)
            prefetch_block(8 * index + static_cast<unsigned>(std::countr_zero(bits)));
          for (; mask != 0; mask &= mask - 1) {
            ++counts.blocks;
            counts.candidates += PhotonBlocks::width;
            const std::size_t block = 8 * index + static_cast<unsigned>(std::countr_zero(mask));
            for (std::size_t lane = 0; lane < PhotonBlocks::width; lane += hn::Lanes(D16()))
              add_photons({map_.blocks, block, lane});
          }
        });
  }

  LaneSums sums, first_sums;
  GroupSums& group_sums;
  QueryCounts counts;

private:
  HWY_INLINE void prefetch_block(std::size_t block) const {
    for (int field = 0; field <= PhotonBlocks::power; ++field)
      hwy::Prefetch(map_.blocks.row(block, field));
  }

  HWY_INLINE void add_photons(const PhotonLanes& photons) {
    const D16 d;
    const I16 di;
    V16 q[3], direction[3];
    for (int axis = 0; axis < 3; ++axis) {
      direction[axis] = hn::Set(d, ray_.direction[axis]);
      q[axis] = hn::Sub(photons.field(axis), hn::Set(d, ray_.origin[axis]));
    }
    const auto t =
        hn::MulAdd(q[0], direction[0], hn::MulAdd(q[1], direction[1], hn::Mul(q[2], direction[2])));
    auto square = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto e = hn::NegMulAdd(t, direction[axis], q[axis]);
      square = hn::MulAdd(e, e, square);
    }
    const auto radius = photons.field(PhotonBlocks::radius);
    const auto area = hn::Mul(radius, radius);
    const auto last = hn::Set(d, ray_.last);
    const auto f = hn::Mul(hn::Sub(t, hn::Set(d, ray_.t_begin)), hn::Set(d, 1 / profile_.step));
    const auto hit =
        hn::And(hn::Lt(square, area), hn::And(hn::Ge(f, hn::Zero(d)), hn::Le(f, last)));
    if (hn::AllFalse(d, hit))
      return;
    counts.contributions += hn::CountTrue(d, hit);
    // A padding photon has no area; its lane is masked, and must not become a NaN.
    const auto inverse = hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(hit, area, hn::Set(d, 1.0f)));
    const auto k = hn::NegMulAdd(square, inverse, hn::Set(d, 1.0f));
    const auto kernel = hn::IfThenElseZero(hit, hn::Mul(kernel_value(kernel_, k), inverse));
    const auto clamped = hn::Max(hn::Min(f, last), hn::Zero(d));
    const auto knot = hn::Min(hn::ConvertTo(di, clamped), hn::Set(di, profile_.knots - 2));
    const auto fraction = hn::Sub(clamped, hn::ConvertTo(d, knot));
    for (std::size_t g = 0; g < profile_.phases->size(); ++g) {
      const auto common =
          hn::Mul(kernel, phase_lanes(photons, (*profile_.phases)[g], ray_.direction));
      auto value = hn::Zero(d);
      for (int c = 0; c < channels_; ++c) {
        if (c < profile_.weight_channels) {
          const std::size_t row = g * static_cast<std::size_t>(profile_.weight_channels) + c;
          const float* table = profile_.weights + row * profile_.knots;
          const auto low = hn::GatherIndex(d, table, knot);
          const auto high = hn::GatherIndex(d, table + 1, knot);
          value = hn::Mul(common, hn::MulAdd(fraction, hn::Sub(high, low), low));
        }
        photons.add(value, c, sums);
        photons.add_to_groups(value, c, 0, group_sums);
        if (first_flights_)
          photons.add_first_flight(value, c, first_sums);
      }
    }
  }

  const MapView& map_;
  const PhotonMap::RayProfile& profile_;
  const NearRay& ray_;
  const KernelPolynomial kernel_;
  const int channels_;
  const bool first_flights_;
};

QueryCounts ray_on_target(const MapView& map, const PhotonMap::RayProfile& profile,
                          const NearRay& ray, LaneSums& sums, LaneSums* first_sums,
                          GroupSums& groups) {
  RayWalk walk(map, profile, ray, first_sums != nullptr, groups);
  walk.run();
  sums = walk.sums;
  if (first_sums)
    *first_sums = walk.first_sums;
  return walk.counts;
}

/// In-scattered light at the origin of `at`, into its direction; at most phases_at_once phase
/// functions.
QueryCounts point_on_target(const MapView& map, const Ray& at,
                            std::span<const PhaseFunction> phases, LaneSums* sums,
                            LaneSums* first_flight, GroupSums& groups) {
  const D16 d;
  const KernelPolynomial kernel = ball_polynomial(map.shape);
  const float x[3] = {at.origin.x, at.origin.y, at.origin.z};
  const float direction[3] = {at.direction.x, at.direction.y, at.direction.z};
  QueryCounts counts;
  const auto add_photons = [&](const PhotonLanes& photons) HWY_ATTR {
    auto square = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis) {
      const auto e = hn::Sub(photons.field(axis), hn::Set(d, x[axis]));
      square = hn::MulAdd(e, e, square);
    }
    const auto radius = photons.field(PhotonBlocks::radius);
    const auto area = hn::Mul(radius, radius);
    const auto hit = hn::Lt(square, area);
    if (hn::AllFalse(d, hit))
      return;
    counts.contributions += hn::CountTrue(d, hit);
    const auto one = hn::Set(d, 1.0f);
    const auto inverse = hn::Div(one, hn::IfThenElse(hit, radius, one));
    const auto inverse_area = hn::Mul(inverse, inverse);
    const auto k = hn::NegMulAdd(square, inverse_area, one);
    const auto value =
        hn::IfThenElseZero(hit, hn::Mul(kernel_value(kernel, k), hn::Mul(inverse_area, inverse)));
    for (std::size_t g = 0; g < phases.size(); ++g) {
      const auto scattered = hn::Mul(value, phase_lanes(photons, phases[g], direction));
      for (int c = 0; c < photons.blocks.channels(); ++c) {
        photons.add(scattered, c, sums[g]);
        photons.add_to_groups(scattered, c, g, groups);
        if (photons.blocks.has_first_flights())
          photons.add_first_flight(scattered, c, first_flight[g]);
      }
    }
  };
  walk_around(map.tree, x, [&](std::size_t block) HWY_ATTR {
    ++counts.blocks;
    counts.candidates += PhotonBlocks::width;
    for (std::size_t lane = 0; lane < PhotonBlocks::width; lane += hn::Lanes(d))
      add_photons({map.blocks, block, lane});
  });
  return counts;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdbeam {

HWY_EXPORT(ray_on_target);
HWY_EXPORT(point_on_target);

namespace {

GroupSums make_group_sums(const MapView& map, const std::vector<Rgb>* groups) {
  return GroupSums(groups ? static_cast<std::size_t>(map.blocks.groups()) * phases_at_once : 0);
}

} // namespace

QueryCounts query_ray(const MapView& map, const PhotonMap::RayProfile& profile, Rgb& radiance,
                      Rgb* first_flight, std::vector<Rgb>* groups) {
  if (groups)
    groups->assign(static_cast<std::size_t>(map.blocks.groups()), {});
  if (map.tree.levels.empty() || profile.knots < 2 || !(profile.step > 0) || !profile.phases)
    return {};
  const NearRay ray = near_ray(profile, map.tree.bounds);
  LaneSums sums, first_sums;
  GroupSums group_sums = make_group_sums(map, groups);
  const QueryCounts counts = HWY_DYNAMIC_DISPATCH(ray_on_target)(
      map, profile, ray, sums, first_flight ? &first_sums : nullptr, group_sums);
  const bool grey = map.blocks.channels() == 1 && profile.weight_channels == 1;
  radiance += sums.total(grey);
  if (first_flight)
    *first_flight += first_sums.total(grey);
  for (std::size_t g = 0; groups && g < groups->size(); ++g)
    (*groups)[g] = group_sums[g * phases_at_once].total(grey);
  return counts;
}

QueryCounts query_point(const MapView& map, const Vec3f& point, const Vec3f& direction,
                        const std::vector<PhaseFunction>& phases, Rgb* in_scattered,
                        Rgb* first_flight, std::vector<Rgb>* groups) {
  const bool grey = map.blocks.channels() == 1;
  if (groups)
    groups->assign(static_cast<std::size_t>(map.blocks.groups()) * phases.size(), {});
  QueryCounts counts;
  for (std::size_t first = 0; first < phases.size(); first += phases_at_once) {
    const std::size_t count = std::min(phases_at_once, phases.size() - first);
    LaneSums sums[phases_at_once], first_sums[phases_at_once];
    GroupSums group_sums = make_group_sums(map, groups);
    if (!map.tree.levels.empty())
      counts = HWY_DYNAMIC_DISPATCH(point_on_target)(
          map, {point, direction}, {phases.data() + first, count}, sums, first_sums, group_sums);
    for (std::size_t i = 0; i < count; ++i) {
      in_scattered[first + i] = sums[i].total(grey);
      if (first_flight)
        first_flight[first + i] = first_sums[i].total(grey);
      for (std::size_t g = 0; g < group_sums.size() / phases_at_once; ++g)
        (*groups)[g * phases.size() + first + i] = group_sums[g * phases_at_once + i].total(grey);
    }
  }
  return counts;
}

} // namespace vdbeam
#endif
