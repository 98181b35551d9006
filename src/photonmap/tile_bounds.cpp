#include "photonmap/tile_bounds.h"

namespace vdbeam {

bool lie_in_cone(const BeamTile& tile, int subtile) {
  // Tangents and knots keep their digits up to here.
  constexpr double least_cosine = 0.2;
  const int first = subtile * BeamTile::rays_per_subtile;
  Vec3d mean;
  bool any = false;
  for (int r = first; r < first + BeamTile::rays_per_subtile; ++r)
    if (const Vec3d d = ray_direction(tile, r); is_live(d)) {
      mean += d;
      any = true;
    }
  const double size = length(mean);
  for (int r = first; any && r < first + BeamTile::rays_per_subtile; ++r)
    if (const Vec3d d = ray_direction(tile, r); is_live(d) && !(dot(d, mean) > least_cosine * size))
      return false;
  return true;
}

RayBounds bound_directions(const BeamTile& tile, int first_ray, int rays) {
  RayBounds box;
  if (tile.own_origins)
    box.start0 = 1e30, box.start1 = -1e30;
  for (int r = first_ray; r < first_ray + rays; ++r) {
    const Vec3d d = ray_direction(tile, r);
    if (!is_live(d))
      continue;
    if (tile.own_origins) {
      box.start0 = std::min(box.start0, static_cast<double>(tile.ow[r]));
      box.start1 = std::max(box.start1, static_cast<double>(tile.ow[r]));
    }
    if (box.wide || d.z < 0.05) {
      box.wide = true;
      box.cos0 = -1;
      box.cos1 = 1;
      if (tile.own_origins)
        continue;
      return box;
    }
    const double a = d.x / d.z, b = d.y / d.z;
    box.a0 = std::min(box.a0, a);
    box.a1 = std::max(box.a1, a);
    box.b0 = std::min(box.b0, b);
    box.b1 = std::max(box.b1, b);
    box.cos0 = std::min(box.cos0, d.z);
    box.cos1 = std::max(box.cos1, d.z);
  }
  const double margin_a = 1e-4 * (box.a1 - box.a0) + 1e-6;
  const double margin_b = 1e-4 * (box.b1 - box.b0) + 1e-6;
  box.a0 -= margin_a;
  box.a1 += margin_a;
  box.b0 -= margin_b;
  box.b1 += margin_b;
  return box;
}

namespace {

/// Least and greatest place of the rays along one axis, at one depth.
struct Span {
  double low = 1e30, high = -1e30;

  void extend(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  void widen() {
    const double margin = 1e-4 * (high - low) + 1e-6 * (std::abs(low) + std::abs(high));
    low -= margin;
    high += margin;
  }
};

} // namespace

void bound_between(const BeamTile& tile, int first_ray, int rays, double w0, double w1,
                   RayBounds& bounds) {
  // At both depths; in between the least of the rays is concave and the greatest convex, so that
  // the chords bound them.
  Span u[2], v[2];
  const double depths[2] = {w0, std::max(w1, w0 + 1e-9 * (std::abs(w0) + 1e-9))};
  for (int r = first_ray; r < first_ray + rays; ++r) {
    const Vec3d d = ray_direction(tile, r), o = ray_start(tile, r);
    if (is_live(d))
      for (int i = 0; i < 2; ++i) {
        const double t = (depths[i] - o.z) / d.z;
        u[i].extend(o.x + d.x * t);
        v[i].extend(o.y + d.y * t);
      }
  }
  for (int i = 0; i < 2; ++i) {
    u[i].widen();
    v[i].widen();
  }
  const double length = depths[1] - depths[0];
  const auto chord = [&](double at0, double at1, double& slope, double& start) {
    slope = (at1 - at0) / length;
    start = at0 - slope * depths[0];
  };
  chord(u[0].low, u[1].low, bounds.a0, bounds.u0);
  chord(u[0].high, u[1].high, bounds.a1, bounds.u1);
  chord(v[0].low, v[1].low, bounds.b0, bounds.v0);
  chord(v[0].high, v[1].high, bounds.b1, bounds.v1);
}

} // namespace vdbeam
