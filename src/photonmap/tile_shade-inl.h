// One photon against the 16 rays of a sub-tile. Included once per SIMD target.
#if defined(VDBEAM_TILE_SHADE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VDBEAM_TILE_SHADE_INL_H_
#undef VDBEAM_TILE_SHADE_INL_H_
#else
#define VDBEAM_TILE_SHADE_INL_H_
#endif

#include "photonmap/tile_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of a tile, channel-major like BeamTile::radiance.
using TileSums = float[3][BeamTile::ray_count];

/// Variant for which the loop over photons is compiled; `plain` as in TileQuery.
template <bool per_ray_, PhaseMode phase_, int power_, int weight_, bool plain_, bool own_>
struct ShadeConfig {
  static constexpr bool per_ray = per_ray_, plain = plain_, own_origins = own_;
  static constexpr PhaseMode phase = phase_;
  static constexpr int power = power_, weight = weight_;
  static constexpr int channels = std::max(power_, weight_);
};

/// Looks the weights up between two knots.
template <class Config>
struct KnotLookup {
  V16 fraction;
  hn::Vec<I16> row; ///< per ray: offset of each ray's weight at the knot
  std::ptrdiff_t shared_row = 0;

  HWY_INLINE V16 at(const float* weights) const {
    const D16 d;
    V16 low, high;
    if constexpr (Config::per_ray) {
      low = hn::GatherIndex(d, weights, row);
      high = hn::GatherIndex(d, weights + 16, row);
    } else {
      low = hn::LoadU(d, weights + shared_row);
      high = hn::LoadU(d, weights + shared_row + 16);
    }
    return hn::MulAdd(fraction, hn::Sub(high, low), low);
  }
};

/// The rays of one vector, in registers.
struct RayLanes {
  V16 a, b, dw, stretch, first, last, ou, ov, knot_shift;
  hn::Vec<I16> lane;
  const float* weights = nullptr; ///< of these rays, in the table of the sub-tile
};

template <bool own_origins>
HWY_INLINE RayLanes load_rays(const SubtileFrame& s, std::size_t lane) {
  const D16 d;
  const auto own = [&](const float* values)
                       HWY_ATTR { return own_origins ? hn::Load(d, values + lane) : hn::Zero(d); };
  return {hn::Load(d, s.a + lane),
          hn::Load(d, s.b + lane),
          hn::Load(d, s.dw + lane),
          hn::Load(d, s.stretch + lane),
          hn::Set(d, s.first_knot),
          hn::Load(d, s.last + lane),
          own(s.ou),
          own(s.ov),
          own(s.knot_shift),
          hn::Iota(I16(), static_cast<std::int32_t>(lane))};
}

/// 1 - s per ray, and where the weights are to be looked up. Negative outside of the kernel.
template <class Config>
HWY_INLINE V16 approach(const Candidates& c, std::size_t i, const SubtileFrame& s,
                        const RayLanes& ray, KnotLookup<Config>& knots) {
  const D16 d;
  const I16 di;
  const auto w = hn::Set(d, c.w[i]), one = hn::Set(d, 1.0f);
  auto x = hn::NegMulAdd(w, ray.a, hn::Set(d, c.u[i]));
  auto y = hn::NegMulAdd(w, ray.b, hn::Set(d, c.v[i]));
  if constexpr (Config::own_origins) {
    const auto inverse_radius = hn::Set(d, c.inverse_radius[i]);
    x = hn::NegMulAdd(inverse_radius, ray.ou, x);
    y = hn::NegMulAdd(inverse_radius, ray.ov, y);
  }
  if constexpr (!Config::per_ray) {
    knots.fraction = hn::Set(d, c.fraction[i]);
    knots.shared_row = c.knot[i];
    return hn::NegMulAdd(y, y, hn::NegMulAdd(x, x, one));
  } else {
    // (x, y, 0) is the offset in the plane across the axis; across the ray itself it is shorter.
    const auto twist = hn::NegMulAdd(y, ray.a, hn::Mul(x, ray.b));
    const auto square = hn::MulAdd(twist, twist, hn::MulAdd(y, y, hn::Mul(x, x)));
    auto k = hn::NegMulAdd(hn::Mul(square, ray.dw), ray.dw, one);
    // t = w / dw + dw (x a + y b), as a difference from w.
    const auto shift = hn::Mul(ray.dw, hn::MulAdd(x, ray.a, hn::Mul(y, ray.b)));
    auto f = hn::MulAdd(hn::Set(d, c.depth[i]), ray.stretch,
                        hn::MulAdd(hn::Set(d, c.reach[i]), shift, hn::Set(d, c.fraction[i])));
    if constexpr (Config::own_origins)
      f = hn::Sub(f, ray.knot_shift);
    const auto inside = hn::And(hn::Ge(f, ray.first), hn::Le(f, ray.last));
    k = hn::IfThenElseZero(inside, k);
    // A ray may end before the table begins (last < 0): the knot must lie in the table all the
    // same.
    const auto clamped = hn::Max(hn::Min(f, ray.last), hn::Zero(d));
    const auto knot = hn::Min(hn::ConvertTo(di, clamped), hn::Set(di, s.knots - 2));
    knots.fraction = hn::Sub(clamped, hn::ConvertTo(d, knot));
    knots.row = hn::Add(hn::ShiftLeft<4>(knot), ray.lane);
    return k;
  }
}

/// Sum over the groups of phase times weight, per weight channel.
template <class Config>
HWY_INLINE void scattering(const TileQuery& query, const SubtileFrame& s, const Candidates& c,
                           std::size_t i, const RayLanes& ray, const KnotLookup<Config>& knots,
                           V16 (&out)[3]) {
  const D16 d;
  const std::size_t groups = Config::plain ? 1 : query.phases.size();
  const std::size_t row = static_cast<std::size_t>(s.knots) * 16;
  V16 cosine = hn::Zero(d);
  if constexpr (Config::phase == PhaseMode::exact)
    cosine = hn::Mul(ray.dw, hn::MulAdd(hn::Set(d, c.phase[0][i]), ray.a,
                                        hn::MulAdd(hn::Set(d, c.phase[1][i]), ray.b,
                                                   hn::Set(d, c.phase[2][i]))));
  for (std::size_t g = 0; g < groups; ++g) {
    V16 phase = hn::Set(d, 1.0f);
    if constexpr (Config::phase == PhaseMode::linear)
      phase = hn::MulAdd(hn::Set(d, c.phase[1][i]), ray.a,
                         hn::MulAdd(hn::Set(d, c.phase[2][i]), ray.b, hn::Set(d, c.phase[0][i])));
    else if constexpr (Config::phase == PhaseMode::exact)
      phase = phase_value(d, query.phases[g], cosine);
    for (int ch = 0; ch < Config::weight; ++ch) {
      const float* table = ray.weights + (g * Config::weight + ch) * row;
      auto value = knots.at(table);
      if constexpr (Config::phase != PhaseMode::isotropic)
        value = hn::Mul(value, phase);
      out[ch] = Config::plain ? value : hn::Add(out[ch], value);
    }
  }
}

/// Which candidates to shade, by number.
struct Selection {
  std::size_t count = 0;
  std::uint16_t index[Candidates::slots];
};

/// Adds the selected candidates to the sub-tile's sums; returns the number of (ray, photon) pairs
/// in kernels.
template <class Config>
HWY_NOINLINE std::uint64_t shade(const TileQuery& query, const SubtileFrame& s, const Candidates& c,
                                 const Selection& selection, std::size_t first_ray,
                                 TileSums& sums) {
  const D16 d;
  const I16 di;
  const auto zero = hn::Zero(d);
  const auto kernel_shift = hn::Set(d, query.kernel_shift);
  auto inside_count = hn::Zero(di);
  for (std::size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    RayLanes ray = load_rays<Config::own_origins>(s, lane);
    ray.weights = s.weights + (Config::per_ray ? 0 : lane);
    float* out = &sums[0][first_ray + lane];
    V16 sum0 = hn::Load(d, out), sum1 = zero, sum2 = zero;
    if constexpr (Config::channels == 3) {
      sum1 = hn::Load(d, out + BeamTile::ray_count);
      sum2 = hn::Load(d, out + 2 * BeamTile::ray_count);
    }
    for (std::size_t j = 0; j < selection.count; ++j) {
      const std::size_t i = selection.index[j];
      KnotLookup<Config> knots;
      auto k = approach<Config>(c, i, s, ray, knots);
      const auto inside = hn::Gt(k, zero);
      inside_count = hn::Sub(inside_count, hn::VecFromMask(di, hn::RebindMask(di, inside)));
      k = hn::Max(k, zero);
      const auto strength = hn::Set(d, c.strength[i]);
      V16 kernel;
      if constexpr (Config::plain)
        kernel = hn::Mul(hn::Mul(k, strength), hn::Add(k, kernel_shift));
      else
        kernel = hn::Mul(strength, kernel_value(query.kernel, k));
      V16 value[3] = {zero, zero, zero};
      scattering<Config>(query, s, c, i, ray, knots, value);
      if constexpr (Config::channels == 1) {
        sum0 = hn::MulAdd(kernel, value[0], sum0);
      } else {
        constexpr int w = Config::weight;
        const auto shared = hn::Mul(kernel, value[0]);
        sum0 = hn::MulAdd(shared, hn::Set(d, c.power[0][i]), sum0);
        sum1 = hn::MulAdd(w == 1 ? shared : hn::Mul(kernel, value[1 % w]),
                          hn::Set(d, c.power[1][i]), sum1);
        sum2 = hn::MulAdd(w == 1 ? shared : hn::Mul(kernel, value[2 % w]),
                          hn::Set(d, c.power[2][i]), sum2);
      }
    }
    hn::Store(sum0, d, out);
    if constexpr (Config::channels == 3) {
      hn::Store(sum1, d, out + BeamTile::ray_count);
      hn::Store(sum2, d, out + 2 * BeamTile::ray_count);
    }
  }
  return static_cast<std::uint64_t>(hn::GetLane(hn::SumOfLanes(di, inside_count)));
}

using Shader = std::uint64_t (*)(const TileQuery&, const SubtileFrame&, const Candidates&,
                                 const Selection&, std::size_t, TileSums&);

template <bool per_ray, PhaseMode phase, bool plain, bool own_origins = false>
Shader choose_channels(const TileQuery& query) {
  if (query.weight_channels == 3)
    return &shade<ShadeConfig<per_ray, phase, 3, 3, plain, own_origins>>;
  if (query.power_channels == 3)
    return &shade<ShadeConfig<per_ray, phase, 3, 1, plain, own_origins>>;
  return &shade<ShadeConfig<per_ray, phase, 1, 1, plain, own_origins>>;
}

/// The loop that fits a sub-tile.
inline Shader choose_shader(const TileQuery& query, const SubtileFrame& s) {
  const bool plain = query.plain, isotropic = s.phase == PhaseMode::isotropic;
  if (s.own_origins)
    return isotropic ? choose_channels<true, PhaseMode::isotropic, false, true>(query)
                     : choose_channels<true, PhaseMode::exact, false, true>(query);
  if (s.per_ray)
    return isotropic ? choose_channels<true, PhaseMode::isotropic, false>(query)
                     : choose_channels<true, PhaseMode::exact, false>(query);
  if (isotropic)
    return plain ? choose_channels<false, PhaseMode::isotropic, true>(query)
                 : choose_channels<false, PhaseMode::isotropic, false>(query);
  if (s.phase == PhaseMode::linear)
    return plain ? choose_channels<false, PhaseMode::linear, true>(query)
                 : choose_channels<false, PhaseMode::linear, false>(query);
  return plain ? choose_channels<false, PhaseMode::exact, true>(query)
               : choose_channels<false, PhaseMode::exact, false>(query);
}

} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#endif
