#include "grids/combined_grid.h"

#include "volume/field_builder.h"
#include "volume/noise.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// Local coordinates of a grid's field -> its world.
Affine local_to_world(const DensityGrid& grid) {
  Affine shift;
  shift.translation = Vec3d(grid.field.origin());
  return grid.index_to_world.after(shift);
}

Boxd occupied(const DensityField& field) {
  const Boxf& box = field.occupied();
  return {Vec3d(box.lower) - Vec3d(1), Vec3d(box.upper) + Vec3d(1)};
}

Boxd extended(Boxd box, const Vec3d& by) {
  box.lower -= by;
  box.upper += by;
  return box;
}

} // namespace

DensityGrid sum_of_grids(std::vector<DensityGrid> grids, const std::string& label,
                         const FieldLimits& limits) {
  const auto first = std::find_if(grids.begin(), grids.end(),
                                  [](const DensityGrid& grid) { return !grid.field.empty(); });
  if (first == grids.end())
    return grids.front();
  DensityGrid sum = std::move(*first);
  grids.erase(first);
  std::erase_if(grids, [](const DensityGrid& grid) { return grid.field.empty(); });
  if (grids.empty())
    return sum;
  const Affine to_world = local_to_world(sum), from_world = to_world.inverse();
  Boxd bounds = occupied(sum.field);
  std::vector<Affine> to_local, to_other;
  for (const DensityGrid& grid : grids) {
    to_local.push_back(from_world.after(local_to_world(grid)));
    to_other.push_back(to_local.back().inverse());
    bounds.extend(to_local.back().bounds(occupied(grid.field)));
  }
  FieldBuilder builder(sum.field, bounds, label);
  for_each_occupied_cell(sum.field, [&](const Boxd& box) { builder.mark(box); });
  for (std::size_t i = 0; i < grids.size(); ++i)
    for_each_occupied_cell(grids[i].field,
                           [&](const Boxd& box) { builder.mark(to_local[i].bounds(box)); });
  const auto value = [&](const Vec3d& local) {
    float total = sum.field.sample(Vec3f(local));
    for (std::size_t i = 0; i < grids.size(); ++i)
      total += grids[i].field.sample(Vec3f(to_other[i].point(local)));
    return total;
  };
  sum.field = builder.build(value, limits);
  for (const DensityGrid& grid : grids) {
    sum.active_voxels += grid.active_voxels;
    sum.notes.insert(sum.notes.end(), grid.notes.begin(), grid.notes.end());
  }
  return sum;
}

DensityGrid displaced_grid(const DensityGrid& grid, const NoiseSettings& noise,
                           const std::string& label, const FieldLimits& limits) {
  if (grid.field.empty() || !(noise.amplitude > 0))
    return grid;
  const Affine to_world = local_to_world(grid), from_world = to_world.inverse();
  // What a displacement within the amplitude along the world's axes is along those of the lattice.
  Vec3d most;
  for (int a = 0; a < 3; ++a) {
    const Vec3d& row = from_world.rows[static_cast<std::size_t>(a)];
    most[a] = noise.amplitude * (std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
  }
  FieldBuilder builder(grid.field, extended(occupied(grid.field), most), label);
  for_each_occupied_cell(grid.field, [&](const Boxd& box) { builder.mark(extended(box, most)); });
  DensityGrid displaced = grid;
  displaced.field = builder.build(
      [&](const Vec3d& local) {
        const Vec3d moved =
            local + from_world.vector(noise_displacement(noise, to_world.point(local)));
        return grid.field.sample(Vec3f(moved));
      },
      limits);
  return displaced;
}

} // namespace vdbeam
