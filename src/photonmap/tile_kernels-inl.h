// The two inner loops of the tile query: 16 photons against a sub-tile's cone, and one photon
// against the sub-tile's 16 rays. Included once per SIMD target.
#if defined(VDBEAM_TILE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VDBEAM_TILE_KERNELS_INL_H_
#undef VDBEAM_TILE_KERNELS_INL_H_
#else
#define VDBEAM_TILE_KERNELS_INL_H_
#endif

#include "photonmap/photon_math-inl.h"
#include "photonmap/tile_frame.h"
#include "photonmap/tree_walk-inl.h"

#ifndef VDBEAM_PACK_ORDER_ONCE_
#define VDBEAM_PACK_ORDER_ONCE_
namespace vdbeam {

/// For each set of 8 lanes: the numbers of its lanes in order, four bits each.
inline constexpr std::array<std::uint32_t, 256> pack_order = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t mask = 0; mask < 256; ++mask)
    for (std::uint32_t lane = 0, at = 0; lane < 8; ++lane)
      if (mask >> lane & 1)
        table[mask] |= lane << (4 * at++);
  return table;
}();

} // namespace vdbeam
#endif

HWY_BEFORE_NAMESPACE();
namespace vdbeam {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Photons near a sub-tile's cone, in its frame; lengths u, v, w in units of the photon's radius.
struct Candidates {
  static constexpr std::size_t capacity = 256;
  static constexpr std::size_t slots = capacity + 32;
  std::size_t count = 0;
  alignas(64) float u[slots], v[slots], w[slots];
  alignas(64) float strength[slots];    ///< 1 / r^2; times power where grey
  alignas(64) float fraction[slots];    ///< shared knots: of the interval; per ray: knot coordinate
  alignas(64) std::int32_t knot[slots]; ///< shared knots: offset of the knot's row of weights
  alignas(64) float depth[slots];       ///< per ray: w / step in length units
  alignas(64) float reach[slots];       ///< per ray: radius / step
  alignas(64) float inverse_radius[slots]; ///< rays with origins of their own
  alignas(64) float phase[3][slots]; ///< linear: value and slopes; exact: -direction in the frame
  alignas(64) float power[3][slots];
  alignas(64) float signed_power[slots]; ///< where the map marks first flights
  alignas(64) float group[slots];        ///< light groups, if photons are marked
};

/// Constants of a query.
struct TileQuery {
  const PhotonBlocks& blocks;
  KernelPolynomial kernel;
  const std::vector<PhaseFunction>& phases;
  int weight_channels;
  int power_channels;
  /// One group, and a kernel square * k (k + shift) of k = 1 - s: `square` goes into the strength.
  bool plain;
  float kernel_shift;

  TileQuery(const PhotonBlocks& blocks_, KernelShape shape, const BeamTile& tile)
      : blocks(blocks_), kernel(disc_polynomial(shape)), phases(*tile.phases),
        weight_channels(tile.weight_channels), power_channels(blocks_.channels()),
        plain(phases.size() == 1 && kernel.step == 0 && kernel.square != 0),
        kernel_shift(plain ? kernel.linear / kernel.square : 0) {}

  /// Sub-tiles with knots per ray have no plain loop.
  float strength_factor(const SubtileFrame& s) const {
    return plain && !s.per_ray ? kernel.square : 1;
  }
};

template <class D>
HWY_INLINE hn::Vec<D> rotate(D d, const float* axis, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z,
                             hn::Vec<D> offset) {
  return hn::MulAdd(hn::Set(d, axis[0]), x,
                    hn::MulAdd(hn::Set(d, axis[1]), y, hn::MulAdd(hn::Set(d, axis[2]), z, offset)));
}

/// Writes all lanes, or the hit ones side by side; the slots after them are scratch.
class LaneWriter {
public:
  HWY_INLINE LaneWriter(hn::Mask<D16> hit, bool keep_all) : hit_(hit), keep_all_(keep_all) {
    if constexpr (hn::MaxLanes(D16()) <= 8) {
      // Highway's Compress would look its permutation up again for every field.
      const I16 di;
      const std::uint32_t packed = pack_order[mask_bits(D16(), hit)];
      const auto shifts = hn::ShiftLeft<2>(hn::Iota(di, 0));
      const auto order =
          hn::And(hn::Shr(hn::Set(di, static_cast<std::int32_t>(packed)), shifts), hn::Set(di, 7));
      hn::Store(order, di, order_);
    }
  }

  template <class D>
  HWY_INLINE void write(D d, hn::Vec<D> value, hn::TFromD<D>* to) const {
    if (keep_all_)
      hn::StoreU(value, d, to);
    else if constexpr (hn::MaxLanes(D16()) <= 8)
      hn::StoreU(hn::TableLookupLanes(value, hn::SetTableIndices(d, order_)), d, to);
    else
      hn::StoreU(hn::Compress(value, hn::RebindMask(d, hit_)), d, to);
  }

private:
  hn::Mask<D16> hit_;
  bool keep_all_;
  alignas(64) std::int32_t order_[16];
};

/// A part of a block, one photon per lane.
struct BlockPart {
  const PhotonBlocks& blocks;
  std::size_t block, lane;

  HWY_INLINE V16 field(int f) const { return hn::Load(D16(), blocks.row(block, f) + lane); }
};

/// Photons in a sub-tile's frame, and their knot coordinate on its axis.
struct PlacedPhotons {
  V16 u, v, w, f, radius;
};

HWY_INLINE PlacedPhotons place_photons(const BlockPart& part, const float* reference,
                                       const SubtileFrame& s) {
  const D16 d;
  const auto x = hn::Sub(part.field(PhotonBlocks::x), hn::Set(d, reference[0]));
  const auto y = hn::Sub(part.field(PhotonBlocks::y), hn::Set(d, reference[1]));
  const auto z = hn::Sub(part.field(PhotonBlocks::z), hn::Set(d, reference[2]));
  const auto along = rotate(d, s.axes[2], x, y, z, hn::Zero(d));
  return {rotate(d, s.axes[0], x, y, z, hn::Set(d, s.offset[0])),
          rotate(d, s.axes[1], x, y, z, hn::Set(d, s.offset[1])),
          hn::Add(along, hn::Set(d, s.offset[2])),
          hn::Mul(hn::Add(along, hn::Set(d, s.knot_offset)), hn::Set(d, s.inverse_step)),
          part.field(PhotonBlocks::radius)};
}

/// Which spheres reach the sub-tile's cone where it has weights. Padding, of radius 0, never does.
HWY_INLINE hn::Mask<D16> reaches_cone(const PlacedPhotons& p, const SubtileFrame& s) {
  const D16 d;
  // Within the radius of the cone: h cos - w sin < r, squared.
  const auto across =
      hn::Mul(hn::MulAdd(p.u, p.u, hn::Mul(p.v, p.v)), hn::Set(d, s.cos_spread * s.cos_spread));
  const auto reach =
      hn::MulAdd(p.w, hn::Set(d, s.sin_spread), hn::Add(p.radius, hn::Set(d, s.cone_width)));
  const auto margin =
      s.per_ray ? hn::MulAdd(p.radius, hn::Set(d, s.inverse_step), hn::Set(d, s.knot_margin))
                : hn::Zero(d);
  auto hit = hn::And(hn::Lt(across, hn::Mul(reach, reach)), hn::Gt(reach, hn::Zero(d)));
  hit = hn::And(hit, hn::Gt(p.radius, hn::Zero(d)));
  hit = hn::And(hit, hn::Ge(p.f, hn::Sub(hn::Set(d, s.first_knot), margin)));
  return hn::And(hit, hn::Le(p.f, hn::Add(hn::Set(d, s.last_knot), margin)));
}

/// Place, size and knots of the hit photons.
HWY_INLINE void write_shape(const TileQuery& query, const SubtileFrame& s, const BlockPart& part,
                            const PlacedPhotons& p, hn::Mask<D16> hit, const LaneWriter& writer,
                            Candidates& out) {
  const D16 d;
  const I16 di;
  const std::size_t at = out.count;
  const auto one = hn::Set(d, 1.0f), inverse_step = hn::Set(d, s.inverse_step);
  const auto inverse_radius = hn::Div(one, hn::IfThenElse(hit, p.radius, one));
  const auto u = hn::IfThenElse(hit, hn::Mul(p.u, inverse_radius), hn::Set(d, 1e9f));
  writer.write(d, u, out.u + at);
  writer.write(d, hn::Mul(p.v, inverse_radius), out.v + at);
  writer.write(d, hn::Mul(p.w, inverse_radius), out.w + at);
  auto strength =
      hn::Mul(hn::Mul(inverse_radius, inverse_radius), hn::Set(d, query.strength_factor(s)));
  if (query.power_channels == 1 && query.weight_channels == 1)
    strength = hn::Mul(strength, part.field(PhotonBlocks::power));
  else
    for (int c = 0; c < 3; ++c)
      writer.write(d, part.field(PhotonBlocks::power + c % query.power_channels),
                   out.power[c] + at);
  writer.write(d, strength, out.strength + at);
  if (query.blocks.has_first_flights())
    writer.write(d, part.field(PhotonBlocks::power), out.signed_power + at);
  if (query.blocks.groups() > 0)
    writer.write(d, part.field(query.blocks.group_field()), out.group + at);
  if (s.per_ray) {
    writer.write(d, p.f, out.fraction + at);
    writer.write(d, hn::Mul(p.w, inverse_step), out.depth + at);
    writer.write(d, hn::Mul(p.radius, inverse_step), out.reach + at);
    if (s.own_origins)
      writer.write(d, inverse_radius, out.inverse_radius + at);
  } else {
    const auto inside = hn::IfThenElseZero(hit, p.f);
    const auto knot =
        hn::Min(hn::ConvertTo(di, inside), hn::Set(di, static_cast<std::int32_t>(s.knots - 2)));
    writer.write(d, hn::Sub(inside, hn::ConvertTo(d, knot)), out.fraction + at);
    writer.write(di, hn::ShiftLeft<4>(knot), out.knot + at);
  }
}

/// Data of the hit photons for the phase function.
HWY_INLINE void write_phase(const TileQuery& query, const SubtileFrame& s, const BlockPart& part,
                            const LaneWriter& writer, Candidates& out) {
  const D16 d;
  const std::size_t at = out.count;
  const int df = part.blocks.direction_field();
  const auto zero = hn::Zero(d);
  const auto dx = part.field(df), dy = part.field(df + 1), dz = part.field(df + 2);
  const auto du = hn::Neg(rotate(d, s.axes[0], dx, dy, dz, zero));
  const auto dv = hn::Neg(rotate(d, s.axes[1], dx, dy, dz, zero));
  const auto dw = hn::Neg(rotate(d, s.axes[2], dx, dy, dz, zero));
  if (s.phase == PhaseMode::linear) {
    auto value = zero, slope = zero;
    phase_line(d, query.phases[0], dw, value, slope);
    writer.write(d, value, out.phase[0] + at);
    writer.write(d, hn::Mul(slope, du), out.phase[1] + at);
    writer.write(d, hn::Mul(slope, dv), out.phase[2] + at);
  } else {
    writer.write(d, du, out.phase[0] + at);
    writer.write(d, dv, out.phase[1] + at);
    writer.write(d, dw, out.phase[2] + at);
  }
}

/// Takes the photons of a block whose spheres reach the sub-tile's cone.
HWY_INLINE void gather_candidates(const TileQuery& query, const float* reference,
                                  const SubtileFrame& s, std::size_t block, Candidates& out) {
  const D16 d;
  for (std::size_t lane = 0; lane < PhotonBlocks::width; lane += hn::Lanes(d)) {
    const BlockPart part{query.blocks, block, lane};
    const PlacedPhotons placed = place_photons(part, reference, s);
    const auto hit = reaches_cone(placed, s);
    const std::size_t hits = hn::CountTrue(d, hit);
    if (hits == 0)
      continue;
    // Where most lanes are hit it is cheaper to keep the others, moved out of reach, than to pack.
    const bool keep_all = 4 * hits >= 3 * hn::Lanes(d);
    const LaneWriter writer(hit, keep_all);
    write_shape(query, s, part, placed, hit, writer, out);
    if (s.phase != PhaseMode::isotropic)
      write_phase(query, s, part, writer, out);
    out.count += keep_all ? hn::Lanes(d) : hits;
  }
}

} // namespace HWY_NAMESPACE
} // namespace vdbeam
HWY_AFTER_NAMESPACE();

#endif
