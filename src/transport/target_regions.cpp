#include "transport/target_regions.h"

#include "transport/photon_targets.h"

namespace vdbeam {

Parallelepiped parallelepiped(const Affine& local_to_render, const Boxd& local) {
  const Vec3d size = local.size();
  return {Vec3f(local_to_render.point(local.lower)),
          {Vec3f(local_to_render.vector({size.x, 0, 0})),
           Vec3f(local_to_render.vector({0, size.y, 0})),
           Vec3f(local_to_render.vector({0, 0, size.z}))}};
}

void add_region(OccupiedRegion& region, const DensityField& field, const Affine& local_to_render) {
  const Boxf& occupied = field.occupied();
  region.boxes.push_back(
      parallelepiped(local_to_render, {Vec3d(occupied.lower), Vec3d(occupied.upper)}));
  const Vec3<int> n = field.cell_counts();
  for (int i = 0; i < n.x; ++i)
    for (int j = 0; j < n.y; ++j)
      for (int k = 0; k < n.z; ++k) {
        if (field.cell_maximum(field.cell_offset(i, j, k)) == 0)
          continue;
        const Vec3d cell = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
        const Vec3d lower = max(cell, Vec3d(occupied.lower));
        const Vec3d upper = min(cell + Vec3d(double{cell_width}), Vec3d(occupied.upper));
        if (lower.x < upper.x && lower.y < upper.y && lower.z < upper.z)
          region.cells.push_back(parallelepiped(local_to_render, {lower, upper}));
      }
}

namespace {

/// Ratio of the radii of neighbouring spheres around a nest. A photon aimed at the wider one
/// carries the square of the ratio times the flux, so a scattering there needs at most about 16
/// copies to light the smaller one evenly.
constexpr float next_sphere = 4;

/// A sphere, and a cube around it.
OccupiedRegion sphere(const Vec3d& center, double radius) {
  OccupiedRegion region;
  region.center = Vec3f(center);
  region.radius = static_cast<float>(radius);
  const Vec3d half(radius * 1.001);
  region.boxes.push_back(parallelepiped(Affine(), {center - half, center + half}));
  region.cells = region.boxes;
  return region;
}

OccupiedRegion sphere_around(const World& world, const std::vector<std::size_t>& nest) {
  Boxd bounds;
  for (const std::size_t v : nest)
    bounds.extend(world.region.boxes[v].bounds());
  return sphere(bounds.center(), 0.5 * length(bounds.size()) * 1.01);
}

/// The volumes of a nest.
OccupiedRegion volumes_of(const World& world, const std::vector<std::size_t>& nest) {
  OccupiedRegion region;
  for (const std::size_t v : nest)
    add_region(region, world.medium.volumes[v].field, world.medium.volumes[v].to_render());
  return region;
}

} // namespace

void choose_targets(World& world) {
  if (!world.surfaces && world.medium.nests.empty())
    return;
  const Nests& nests = world.medium.nests;
  for (std::size_t n = 0; n < nests.size(); ++n) {
    const OccupiedRegion nest = sphere_around(world, nests[n]);
    if (n == 0) {
      world.targets.push_back(volumes_of(world, nests[n]));
      world.targets.back().center = nest.center;
      world.targets.back().radius = nest.radius;
      world.first_sphere = 1;
    }
    const float end =
        n + 1 < nests.size() ? sphere_around(world, nests[n + 1]).radius : world.region.radius;
    world.targets.push_back(nest);
    for (float radius = nest.radius * next_sphere; 2 * radius < end; radius *= next_sphere)
      world.targets.push_back(sphere(Vec3d(nest.center), static_cast<double>(radius)));
  }
  if (!world.region.boxes.empty())
    world.targets.push_back(world.region);
  world.medium_targets = world.targets.size();
  if (world.surfaces)
    add_surface_targets(world.region, *world.surfaces->set, world.targets);
}

} // namespace vdbeam
