#include "photonmap/tile_frame.h"

#include "math/sampling.h"
#include "photonmap/tile_bounds.h"

#include <bit>

namespace vdbeam {
namespace {

constexpr int rays = BeamTile::rays_per_subtile;

/// Tangent of the widest cone whose rays share knots and measure distances across its axis.
constexpr double widest_shared_spread = 0.05;

bool row_is_zero(const float* weights, std::size_t rows, int knots, int knot) {
  for (std::size_t row = 0; row < rows; ++row) {
    const float* w = weights + (row * static_cast<std::size_t>(knots) + knot) * rays;
    std::uint32_t bits = 0; // of all values together, without signs
    for (int r = 0; r < rays; ++r)
      bits |= std::bit_cast<std::uint32_t>(w[r]);
    if ((bits & 0x7fffffffu) != 0)
      return false;
  }
  return true;
}

/// Narrows [first_knot, last_knot] to where some weight is not 0; false if none is.
bool trim_knots(std::size_t rows, SubtileFrame& s) {
  int first = 0, last = s.knots - 1;
  while (first <= last && row_is_zero(s.weights, rows, s.knots, first))
    ++first;
  while (last > first && row_is_zero(s.weights, rows, s.knots, last))
    --last;
  s.first_knot = static_cast<float>(std::max(0, first - 1));
  s.last_knot = static_cast<float>(std::min(s.knots - 1, last + 1));
  return first < s.knots;
}

/// A vector of the tile's frame in the sub-tile's.
Vec3d in_subtile(const Vec3d& v, const BeamTile& tile, const SubtileFrame& s) {
  const Vec3d world =
      Vec3d(tile.axis_u) * v.x + Vec3d(tile.axis_v) * v.y + Vec3d(tile.axis_w) * v.z;
  Vec3d result;
  for (int i = 0; i < 3; ++i)
    result[i] = dot(Vec3d{s.axes[i][0], s.axes[i][1], s.axes[i][2]}, world);
  return result;
}

/// Fills axes and the rays' coordinates; returns the cone's tangent, negative without any ray.
double fill_rays(const BeamTile& tile, int subtile, SubtileFrame& s) {
  Vec3d mean;
  for (int r = 0; r < rays; ++r) {
    const Vec3d d = ray_direction(tile, subtile * rays + r);
    if (is_live(d))
      mean += d;
  }
  if (!(dot(mean, mean) > 1e-6))
    return -1;
  const Vec3d w = normalize(mean);
  Vec3d u, v;
  orthonormal_frame(w, u, v);
  float spread = 0; // squared
  for (int r = 0; r < rays; ++r) {
    const Vec3d d = ray_direction(tile, subtile * rays + r);
    const bool live = is_live(d);
    const double inverse = 1 / std::max(dot(d, w), 1e-3);
    s.a[r] = live ? static_cast<float>(dot(d, u) * inverse) : 0.0f;
    s.b[r] = live ? static_cast<float>(dot(d, v) * inverse) : 0.0f;
    const float square = s.a[r] * s.a[r] + s.b[r] * s.b[r];
    s.stretch[r] = square / (1 + std::sqrt(1 + square)); // sqrt(1 + square) - 1
    s.dw[r] = 1 / (1 + s.stretch[r]);
    s.scale[r] = live ? 1.0f : 0.0f;
    spread = std::max(spread, square);
  }
  const Vec3d axes[3] = {u, v, w};
  for (int i = 0; i < 3; ++i) {
    const Vec3d axis = Vec3d(tile.axis_u) * axes[i].x + Vec3d(tile.axis_v) * axes[i].y +
                       Vec3d(tile.axis_w) * axes[i].z;
    for (int j = 0; j < 3; ++j)
      s.axes[i][j] = static_cast<float>(axis[j]);
    s.offset[i] = static_cast<float>(axes[i].z * tile.camera_distance);
  }
  s.knot_offset = static_cast<float>(w.z * tile.camera_distance - tile.profiles[subtile].t_begin);
  return std::sqrt(static_cast<double>(spread));
}

/// Whether the phase functions are as good as linear over a cone of this tangent: the second-order
/// term of (1 + g^2 - 2 g cos)^(-3/2), relative, is at most 15/8 g (spread / (1 - |g|))^2. P_l
/// bends by l (l + 1) / 4 spread^2.
PhaseMode phase_mode(const std::vector<PhaseFunction>& phases, double spread, bool has_directions) {
  double error = 0;
  bool isotropic = true;
  for (const PhaseFunction& phase : phases) {
    const int l = phase.coefficient_count() - 1;
    if (l > 0)
      error = std::max(error, 0.25 * l * (l + 1) * spread * spread);
    isotropic = isotropic && l <= 0;
    for (int i = 0; i < phase.lobe_count(); ++i) {
      const DraineLobe& lobe = phase.lobe(i);
      const double g = std::abs(lobe.g), width = spread / std::max(1 - g, 1e-6);
      isotropic = isotropic && lobe.g == 0 && lobe.alpha == 0;
      error = std::max(error, 2 * g * width * width + std::abs(lobe.alpha) * spread * spread);
    }
  }
  if (isotropic || !has_directions)
    return PhaseMode::isotropic;
  return error < 1e-3 && phases.size() == 1 ? PhaseMode::linear : PhaseMode::exact;
}

/// The rest of a sub-tile whose rays have origins of their own: where they start, and the cone that
/// holds them where they have weights.
void finish_own_origins(const BeamTile& tile, int index, float reach, bool has_directions,
                        SubtileFrame& s) {
  const BeamTile::Profile& profile = tile.profiles[index];
  const double t0 = profile.t_begin + static_cast<double>(s.first_knot) * profile.step;
  const double t1 = profile.t_begin + static_cast<double>(s.last_knot) * profile.step;
  double w0 = 1e30, w1 = -1e30, largest_shift = 0, largest_stretch = 0;
  for (int r = 0; r < rays; ++r) {
    const Vec3d o = in_subtile(ray_start(tile, index * rays + r), tile, s);
    s.ou[r] = static_cast<float>(o.x - s.a[r] * o.z);
    s.ov[r] = static_cast<float>(o.y - s.b[r] * o.z);
    const double shift = o.z / s.dw[r] / profile.step;
    s.knot_shift[r] = static_cast<float>(shift);
    if (s.scale[r] == 0)
      continue;
    w0 = std::min(w0, o.z + t0 * s.dw[r]);
    w1 = std::max(w1, o.z + t1 * s.dw[r]);
    largest_shift = std::max(largest_shift, std::abs(shift));
    largest_stretch = std::max(largest_stretch, static_cast<double>(s.stretch[r]));
  }
  w1 = std::max(w1, w0 + 1e-9 * (std::abs(w0) + 1e-9));
  // The greatest distance from the axis is convex in w: a chord bounds it where weights are.
  double off0 = 0, off1 = 0;
  for (int r = 0; r < rays; ++r)
    if (s.scale[r] != 0) {
      off0 = std::max(off0, std::hypot(s.ou[r] + s.a[r] * w0, s.ov[r] + s.b[r] * w0));
      off1 = std::max(off1, std::hypot(s.ou[r] + s.a[r] * w1, s.ov[r] + s.b[r] * w1));
    }
  const double slope = (off1 - off0) / (w1 - w0), cosine = 1 / std::sqrt(1 + slope * slope);
  const double margin = 1e-5 * (off0 + off1) + 1e-7 * reach;
  s.cos_spread = static_cast<float>(cosine);
  s.sin_spread = static_cast<float>(slope * cosine);
  s.cone_width = static_cast<float>((off0 - slope * w0 + margin) * cosine);
  s.per_ray = true;
  const double farthest = tile.camera_distance + reach;
  s.knot_margin = static_cast<float>(largest_stretch * farthest / profile.step + largest_shift + 1);
  s.phase = phase_mode(*tile.phases, 1, has_directions);
  if (s.phase == PhaseMode::linear)
    s.phase = PhaseMode::exact;
  for (int r = 0; r < rays && s.phase == PhaseMode::isotropic; ++r)
    s.scale[r] /= 4 * pi;
}

/// Each ray ends at its own surface. True where one does.
bool end_rays(const BeamTile& tile, int index, SubtileFrame& s) {
  const BeamTile::Profile& profile = tile.profiles[index];
  bool any = false;
  for (int r = 0; r < rays; ++r) {
    const double end = tile.end[static_cast<std::size_t>(index * rays + r)];
    s.last[r] = s.last_knot;
    if (end == std::numeric_limits<double>::infinity())
      continue;
    any = true;
    s.last[r] = static_cast<float>(
        std::min(static_cast<double>(s.last_knot), (end - profile.t_begin) / profile.step));
  }
  return any;
}

void make_subtile(const BeamTile& tile, int index, float mean_radius, float reach,
                  bool has_directions, SubtileFrame& s) {
  const BeamTile::Profile& profile = tile.profiles[index];
  s.active = s.single = false;
  if (profile.knots < 2 || !(profile.step > 0) || !tile.phases || tile.phases->empty())
    return;
  s.weights = tile.weights.data() + profile.offset;
  s.knots = profile.knots;
  if (!trim_knots(tile.rows(), s))
    return;
  if (!lie_in_cone(tile, index)) {
    s.single = true;
    return;
  }
  const double spread = fill_rays(tile, index, s);
  if (spread < 0)
    return;
  s.active = true;
  s.inverse_step = 1 / profile.step;
  s.cone_width = 0;
  s.own_origins = tile.own_origins;
  const bool cut = end_rays(tile, index, s);
  if (tile.own_origins)
    return finish_own_origins(tile, index, reach, has_directions, s);
  const double cosine = 1 / std::sqrt(1 + spread * spread);
  s.cos_spread = static_cast<float>(cosine);
  s.sin_spread = static_cast<float>(std::min(1.0, spread * cosine * (1 + 1e-5) + 1e-7));
  // Rays that share a knot see a photon at the distance along the cone's axis instead of their own.
  // Seen from them it is moved along the ray, by spread * radius (to either side, by where it lies)
  // and by depth * spread^2 / 2: nothing that a kernel of that radius would resolve.
  const double farthest = tile.camera_distance + reach;
  const double by_depth = farthest * spread * spread / 2;
  s.per_ray = cut || spread > widest_shared_spread ||
              by_depth > std::max(0.0625 * profile.step, 0.05 * mean_radius);
  s.knot_margin = static_cast<float>((1 / cosine - 1) * farthest / profile.step + 1);
  s.phase = phase_mode(*tile.phases, spread, has_directions);
  if (s.per_ray && s.phase == PhaseMode::linear)
    s.phase = PhaseMode::exact;
  for (int r = 0; r < rays; ++r) {
    // Distances in the plane across the cone's axis: the kernel's area shrinks by dw.
    if (!s.per_ray)
      s.scale[r] /= s.dw[r];
    if (s.phase == PhaseMode::isotropic)
      s.scale[r] /= 4 * pi;
  }
}

void set_plane(float* plane, const TileFrame& frame, double cu, double cv, double cw, double offset,
               double reach) {
  for (int j = 0; j < 3; ++j)
    plane[j] =
        static_cast<float>(cu * frame.axes[0][j] + cv * frame.axes[1][j] + cw * frame.axes[2][j]);
  plane[3] = static_cast<float>(offset + 2 * frame.margin);
  plane[4] = static_cast<float>(reach);
}

void make_planes(const RayBounds& box, double w0, double w1, TileFrame& frame) {
  const double distance = frame.camera_distance;
  const double tangent =
      std::max({std::abs(box.a0), std::abs(box.a1), std::abs(box.b0), std::abs(box.b1)});
  const double side = std::sqrt(1 + tangent * tangent);
  const double depth = box.wide ? 1 : std::sqrt(std::max(0.0, 1 - box.cos0 * box.cos0)) + 1e-6;
  frame.side_reach = box.wide ? 1e3f : static_cast<float>(side);
  frame.depth_reach = static_cast<float>(depth);
  for (int i = 0; i < 4; ++i)
    set_plane(frame.planes[i], frame, 0, 0, 0, 1, 0);
  if (!box.wide) {
    set_plane(frame.planes[0], frame, 1, 0, -box.a0, -box.a0 * distance - box.u0, side);
    set_plane(frame.planes[1], frame, -1, 0, box.a1, box.a1 * distance + box.u1, side);
    set_plane(frame.planes[2], frame, 0, 1, -box.b0, -box.b0 * distance - box.v0, side);
    set_plane(frame.planes[3], frame, 0, -1, box.b1, box.b1 * distance + box.v1, side);
  }
  set_plane(frame.planes[4], frame, 0, 0, 1, distance - w0, depth);
  set_plane(frame.planes[5], frame, 0, 0, -1, w1 - distance, depth);
}

/// Bounds and depths of one sub-tile, for culling.
void bound_subtile(const BeamTile& tile, int index, TileFrame& frame, RayBounds& all) {
  RayBounds box = bound_directions(tile, index * rays, rays);
  const BeamTile::Profile& profile = tile.profiles[index];
  const SubtileFrame& s = frame.subtiles[index];
  const double t0 = profile.t_begin + static_cast<double>(s.first_knot) * profile.step;
  const double t1 = profile.t_begin + static_cast<double>(s.last_knot) * profile.step;
  // A ray at t has depth t dw from its start; rounded outwards.
  const double w0 = std::min(t0 * box.cos0, t0 * box.cos1) + box.start0;
  const double w1 = std::max(t1 * box.cos0, t1 * box.cos1) + box.start1;
  if (tile.own_origins && !box.wide)
    bound_between(tile, index * rays, rays, w0, w1, box);
  frame.w0[index] = static_cast<float>(w0 - 1e-6 * std::abs(w0) - frame.margin);
  frame.w1[index] = static_cast<float>(w1 + 1e-6 * std::abs(w1) + frame.margin);
  frame.a0[index] = static_cast<float>(box.a0);
  frame.a1[index] = static_cast<float>(box.a1);
  frame.b0[index] = static_cast<float>(box.b0);
  frame.b1[index] = static_cast<float>(box.b1);
  frame.u0[index] = static_cast<float>(box.u0);
  frame.u1[index] = static_cast<float>(box.u1);
  frame.v0[index] = static_cast<float>(box.v0);
  frame.v1[index] = static_cast<float>(box.v1);
  frame.active |= 1u << index;
  if (box.wide)
    frame.wide |= 1u << index;
  all.extend(box);
}

} // namespace

void make_tile_frame(const BeamTile& tile, float mean_radius, float reach, bool has_directions,
                     TileFrame& frame) {
  const Vec3f axes[3] = {tile.axis_u, tile.axis_v, tile.axis_w};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      frame.axes[i][j] = axes[i][j];
  for (int j = 0; j < 3; ++j)
    frame.reference[j] = tile.reference[j];
  frame.camera_distance = static_cast<float>(tile.camera_distance);
  frame.margin = 1e-6f * reach;
  RayBounds all;
  double nearest = 1e30, farthest = -1e30;
  for (int i = 0; i < BeamTile::subtile_count; ++i) {
    frame.a0[i] = frame.b0[i] = frame.w0[i] = 1e30f;
    frame.a1[i] = frame.b1[i] = frame.w1[i] = -1e30f;
    frame.u0[i] = frame.u1[i] = frame.v0[i] = frame.v1[i] = 0;
    make_subtile(tile, i, mean_radius, reach, has_directions, frame.subtiles[i]);
    if (!frame.subtiles[i].active)
      continue;
    bound_subtile(tile, i, frame, all);
    nearest = std::min(nearest, static_cast<double>(frame.w0[i]));
    farthest = std::max(farthest, static_cast<double>(frame.w1[i]));
  }
  if (tile.own_origins && !all.wide)
    bound_between(tile, 0, BeamTile::ray_count, nearest, farthest, all);
  make_planes(all, nearest, farthest, frame);
}

} // namespace vdbeam
