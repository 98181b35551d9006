#pragma once

#include "photonmap/photon_blocks.h"
#include "photonmap/photon_map.h"

namespace vdbeam {

/// How a sub-tile's phase function is evaluated: linear over its cone where that is narrow enough.
enum class PhaseMode { isotropic, linear, exact };

/// The 4 x 4 rays of a sub-tile in a frame of their own, whose third axis is their mean direction
/// and whose origin is the rays' common one. Positions enter relative to the tile's reference.
struct SubtileFrame {
  alignas(64) float a[16]; ///< tangents of the ray: (a, b, 1) / |(a, b, 1)| is its direction
  alignas(64) float b[16];
  alignas(64) float dw[16];      ///< third component of the unit direction
  alignas(64) float stretch[16]; ///< 1 / dw - 1
  alignas(64) float last[16];    ///< per ray: f beyond which there is no weight
  alignas(64) float scale[16];   ///< final factor of the ray's sum; 0 for a ray without direction
  /// For rays with individual origins: their points on the plane w = 0, and the number of knots by
  /// which their distances begin before it.
  alignas(64) float ou[16], ov[16], knot_shift[16];
  float axes[3][3];  ///< rows: u, v, w in render space
  float offset[3];   ///< the reference seen from the camera, in this frame
  float knot_offset; ///< knot coordinate f = (w . (p - reference) + knot_offset) / step
  float inverse_step;
  float first_knot, last_knot;  ///< f outside gives no weight
  float knot_margin;            ///< by how much f may differ between the rays for one photon
  float sin_spread, cos_spread; ///< of the cone around all rays
  float cone_width;     ///< by how much that cone is wider, where rays do not meet in one point
  const float* weights; ///< [(group * channels + c)][knot][16]
  int knots;
  bool active;
  bool single;      ///< gathered ray by ray; not active then
  bool per_ray;     ///< knots looked up and distances taken exactly per ray
  bool own_origins; ///< then per_ray too
  PhaseMode phase;
};

/// A tile made ready for the traversal.
struct TileFrame {
  SubtileFrame subtiles[BeamTile::subtile_count];
  /// Bounds of the sub-tiles' rays (RayBounds) and their depth ranges in the tile's frame, for
  /// culling boxes.
  alignas(64) float a0[16], a1[16], b0[16], b1[16], w0[16], w1[16];
  alignas(64) float u0[16], u1[16], v0[16], v1[16];
  float axes[3][3]; ///< rows: the tile's u, v, w
  float reference[3];
  float camera_distance;
  float margin; ///< outward margin of the box tests [length]
  /// Planes around the tile's frustum: n . (p - reference) + offset + reach * radius >= 0, as
  /// (n, offset, reach).
  float planes[6][5];
  /// How far a sphere of radius 1 reaches across a side of a pyramid, and along the tile's axis a
  /// photon may lie from its closest point on a ray.
  float side_reach, depth_reach;
  std::uint32_t active = 0; ///< bit per sub-tile
  std::uint32_t wide = 0;   ///< sub-tiles whose rays the tangents do not bound
};

/// `reach`: greatest distance of the photons' bounds from the tile's reference; `mean_radius`
/// decides whether rays may share knots. Reads tile.weights; the result points into them.
void make_tile_frame(const BeamTile& tile, float mean_radius, float reach, bool has_directions,
                     TileFrame& frame);

} // namespace vdbeam
