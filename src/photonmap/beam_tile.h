#pragma once

#include "phase/phase_function.h"

#include <array>
#include <limits>
#include <vector>

namespace vdbeam {

/// 16 x 16 camera rays, as the beam query takes them: 16 sub-tiles of 4 x 4 rays. Ray r of sub-tile
/// s has index 16 s + r everywhere below. All start at one point, unless `own_origins` is set.
///
/// All positions are relative to `reference`, a point of the tile's central ray near the medium, in
/// the tile's frame (axis_u, axis_v, axis_w), so a camera far away costs no precision: a ray starts
/// at w = -camera_distance on the frame's w axis and t is the distance from there.
struct BeamTile {
  static constexpr int subtile_count = 16;
  static constexpr int rays_per_subtile = 16;
  static constexpr int ray_count = 256;

  Vec3f reference;                   ///< render space
  Vec3f axis_u, axis_v, axis_w;      ///< orthonormal; w is the central direction
  double camera_distance = 0;        ///< from the rays' origin to `reference`
  alignas(64) float du[ray_count]{}; ///< unit directions in the tile's frame
  alignas(64) float dv[ray_count]{};
  alignas(64) float dw[ray_count]{};
  bool own_origins = false; ///< a ray starts at (ou, ov, ow) from that point, in the tile's frame
  alignas(64) float ou[ray_count]{};
  alignas(64) float ov[ray_count]{};
  alignas(64) float ow[ray_count]{};
  /// Distance at which a ray ends at a surface; infinite where it does not. What lies beyond does
  /// not count, whatever the weights.
  std::array<double, ray_count> end = endless();
  /// Offset from a distance along a ray of render space to the t of this tile.
  std::array<double, ray_count> shift{};

  /// Weight of a photon at distance t on each ray, per sub-tile at uniform knots
  /// t_k = t_begin + k * step, linear in between, 0 before the first and after the last knot:
  /// W(t) = Tr(0, t) * sigma_s(t), for each group of volumes that share a phase function and, where
  /// the extinction is chromatic, each channel.
  struct Profile {
    double t_begin = 0; ///< double, so that a far camera costs the knots no precision
    float step = 1;
    int knots = 0;          ///< 0: this sub-tile sees nothing
    std::size_t offset = 0; ///< into `weights` of [(group * weight_channels + c)][knot][16]
  };
  using Profiles = std::array<Profile, subtile_count>;
  Profiles profiles;           ///< of the part of the medium that is asked for
  std::vector<Profiles> parts; ///< of each part; empty where there is one only
  std::vector<float> weights;  ///< 64-byte alignment not required
  int weight_channels = 1;     ///< 1, or 3 where extinction is chromatic
  const std::vector<PhaseFunction>* phases = nullptr; ///< one per group

  /// Rows of weights: groups of volumes times channels.
  std::size_t rows() const { return phases->size() * static_cast<std::size_t>(weight_channels); }
  std::size_t part_count() const { return parts.empty() ? 1 : parts.size(); }
  /// Asks for the weights of a part of the medium.
  void choose_part(std::size_t part) {
    if (!parts.empty())
      profiles = part < parts.size() ? parts[part] : Profiles();
  }

  /// Out: per channel of the photons (1 or 3), per ray, sum over photons and groups of
  /// K(d, r) * W(t) * p(cos) * power. Channel-major: radiance[c * ray_count + ray]. Added to.
  std::vector<float> radiance;
  /// Out: the part of it that comes from photons on their first flight, single scattering. Empty
  /// where the map has no such photons.
  std::vector<float> first_flight;
  /// Whether the parts of groups of lights are asked for.
  bool by_group = false;
  /// Out: those parts, as `radiance` for each group, one after the other. Added to. Empty where the
  /// map has no groups.
  std::vector<float> group_radiance;

private:
  static std::array<double, ray_count> endless() {
    std::array<double, ray_count> ends;
    ends.fill(std::numeric_limits<double>::infinity());
    return ends;
  }
};

/// Whether the rays of a sub-tile lie in a cone around their mean direction. Those of a lens that
/// is wider than its focus is far may not; they are gathered ray by ray. True without any ray.
bool lie_in_cone(const BeamTile& tile, int subtile);

/// Counts of a query, for the report and for tuning.
struct QueryCounts {
  std::uint64_t contributions = 0; ///< (ray, photon) pairs within the kernel
  std::uint64_t candidates = 0;    ///< (ray, photon) pairs evaluated
  std::uint64_t blocks = 0;        ///< photon blocks visited

  QueryCounts& operator+=(const QueryCounts& other) {
    contributions += other.contributions;
    candidates += other.candidates;
    blocks += other.blocks;
    return *this;
  }
};

} // namespace vdbeam
