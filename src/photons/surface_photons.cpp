#include "photons/surface_photons.h"

#include "math/sampling.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbeam {
namespace {

/// Photons at grazing incidence have no reliable side and are ignored.
constexpr float least_cosine = 1e-5f;
/// How far from the tangent plane photons may lie, as a share of their radius: what curved surfaces
/// need, and little of a wall that stands on this one.
constexpr float flatness = 0.1f;
/// Three rings of six, at the sixths of the biweight disc's weight: 1 - (1 - s)^3 = 1/6, 3/6, 5/6.
constexpr float disc_rings[3] = {0.243f, 0.454f, 0.671f};
constexpr int ring_points = 6;
constexpr int points = 3 * ring_points;
/// Cosine between the normals of parts of one surface, at least.
constexpr float like_normal = 0.7f;

} // namespace

/// About a point, with the normal on the side from which it is seen.
struct SurfacePhotons::Disc {
  Vec3d center, normal, above; ///< `above`: the center, lifted off the surface
  double lift = 0;
  float radius = 0;
  std::size_t surface = 0;
  bool alone = false;  ///< nothing but the surface, which is flat, is near
  bool hidden = false; ///< something stands in the disc
};

/// Nothing stands between the lifted centre and a point of the plane, lifted by the same height.
bool SurfacePhotons::sees(const Disc& disc, const Vec3d& point) const {
  if (disc.alone)
    return true;
  const Vec3d to = point + disc.normal * disc.lift - disc.above;
  const double distance = length(to);
  return !(distance > 0) || !surfaces_.set->occluded(disc.above, to / distance, 0, distance);
}

/// Photons can lie under the point.
bool SurfacePhotons::on_surface(const Disc& disc, const Vec3d& point) const {
  if (disc.alone)
    return surfaces_.set->holds(disc.surface, point);
  const auto hit =
      surfaces_.set->intersect(point + disc.normal * disc.lift, -disc.normal, 0, 2 * disc.lift);
  return hit && surfaces_.material(*hit).takes_photons() &&
         std::abs(dot(Vec3d(hit->normal), disc.normal)) > static_cast<double>(like_normal);
}

/// Fraction of the kernel about the centre, weighted by its value, in which photons can lie.
float SurfacePhotons::share(Disc& disc, Rng& rng) const {
  Vec3f u, v;
  orthonormal_frame(Vec3f(disc.normal), u, v);
  const float turned = rng.uniform();
  int found = 0;
  for (int i = 0; i < points; ++i) {
    const int ring = i / ring_points;
    // Each ring is turned by a third of a step against the last.
    const float step = static_cast<float>(i % ring_points) + turned + static_cast<float>(ring) / 3;
    const float angle = 2 * pi * step / ring_points, r = disc.radius * disc_rings[ring];
    const Vec3d point = disc.center + Vec3d(u * (r * std::cos(angle)) + v * (r * std::sin(angle)));
    const bool seen = sees(disc, point);
    disc.hidden = disc.hidden || !seen;
    found += seen && on_surface(disc, point);
  }
  return static_cast<float>(std::max(found, 1)) / points;
}

GroupedLight SurfacePhotons::reflected(const SurfaceVertex& vertex, Rng& rng) const {
  struct Near {
    Vec3f position;
    Rgb light;
    int group;
  };
  std::vector<Near> near;
  const SurfaceHit& hit = vertex.hit();
  float weights = 0, radii = 0;
  std::vector<DiscPhoton> found;
  map_.find_on_disc(Vec3f(hit.position), found);
  near.reserve(found.size());
  for (const DiscPhoton& photon : found) {
    const float off = std::abs(dot(photon.position - Vec3f(hit.position), hit.normal));
    const float cosine = std::abs(dot(photon.direction, hit.normal));
    if (off > flatness * photon.radius || !(cosine > least_cosine))
      continue;
    const float weight = mean_component(photon.irradiance);
    weights += weight;
    radii += weight * photon.radius;
    // The power is that of irradiance about the shading normal (arriving_factor).
    const Rgb light = vertex.evaluate(-photon.direction) * photon.irradiance;
    if (max_component(light) > 0)
      near.push_back(
          {photon.position, light / vertex.shading_cosine(-photon.direction), photon.group});
  }
  if (near.empty() || !(weights > 0))
    return {};
  Disc disc;
  disc.center = hit.position;
  disc.normal = Vec3d(vertex.front() ? hit.normal : -hit.normal);
  disc.radius = radii / weights;
  disc.lift = static_cast<double>(flatness * disc.radius);
  disc.surface = static_cast<std::size_t>(hit.surface);
  disc.alone = surfaces_.set->is_flat_and_alone(disc.surface, disc.center,
                                                static_cast<double>(disc.radius) + disc.lift);
  // Under a low ceiling half of its height.
  if (!disc.alone)
    if (const auto ceiling =
            surfaces_.set->intersect(hit.leave(Vec3f(disc.normal)), disc.normal, 0, disc.lift))
      disc.lift = 0.5 * ceiling->t;
  disc.above = disc.center + disc.normal * disc.lift;
  const float part = share(disc, rng);
  GroupedLight sum;
  for (const Near& photon : near)
    if (!disc.hidden || sees(disc, Vec3d(photon.position)))
      sum.add(photon.light, photon.group);
  return sum * vertex.absorbed() / part;
}

} // namespace vdbeam
