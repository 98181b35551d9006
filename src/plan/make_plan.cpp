#include "camera/camera.h"
#include "grids/fog_grid.h"
#include "plan/grids_once.h"
#include "plan/plan.h"
#include "plan/surface_files.h"
#include "prepare/read_volumes.h"
#include "vdb/density_kind.h"
#include "vdb/vdb_reader.h"

#include <algorithm>

namespace vdbeam {
namespace {

/// World bounds of all that a grid can make visible: a border voxel ramps to 0 over one voxel.
Boxd visible_bounds(const GridSummary& grid, const std::array<double, 12>& m) {
  const Affine map = Affine::from_matrix(m).after(grid.index_to_world);
  return map.bounds({Vec3d(grid.index_lower) - Vec3d(1), Vec3d(grid.index_upper) + Vec3d(1)});
}

/// The header of a grid, cropped as reading the grid will crop it: voxels inside the box that may
/// be active count as active. What moves may come from anywhere.
GridSummary read_header(const Scene& scene, const VolumeSettings& volume, const std::string& name,
                        GridsOnce& grids) {
  if (volume.fog.made())
    return fog_header(volume);
  GridSummary grid = grids.header(volume.file, name);
  const std::optional<WantedBox> wanted = wanted_box(volume, nullptr);
  if (!wanted || !scene.moments.empty() || grid.active_voxels == 0 || is_level_set(grid))
    return grid;
  const WantedBox::Voxels voxels = wanted->voxels(grid.index_to_world);
  double inside = 1;
  for (int a = 0; a < 3; ++a) {
    grid.index_lower[a] = std::max(grid.index_lower[a], voxels.lower[a]);
    grid.index_upper[a] = std::min(grid.index_upper[a], voxels.upper[a]);
    inside *= std::max(0.0, static_cast<double>(grid.index_upper[a] - grid.index_lower[a] + 1));
  }
  if (inside < static_cast<double>(grid.active_voxels))
    grid.active_voxels = static_cast<std::uint64_t>(inside);
  return grid;
}

/// Voxels of the grids that a volume's emission is made from, as their headers say; 0 where one of
/// them is empty.
std::uint64_t count_glowing_voxels(const Scene& scene, const VolumeSettings& volume, Boxd& bounds,
                                   GridsOnce& grids) {
  std::uint64_t voxels = 0;
  if (!volume.glows())
    return voxels;
  for (const std::string& name : {volume.emission.temperature, volume.emission.intensity}) {
    if (name.empty())
      continue;
    const GridSummary grid = read_header(scene, volume, name, grids);
    if (grid.active_voxels == 0)
      return 0;
    voxels += grid.active_voxels;
    bounds.extend(visible_bounds(grid, volume.transform));
  }
  return voxels;
}

} // namespace

RenderPlan make_plan(const Scene& scene) {
  std::vector<VolumeFacts> facts;
  Boxd bounds;
  GridsOnce grids;
  for (const VolumeSettings& volume : scene.volumes) {
    VolumeFacts fact{true, 0};
    if (volume.needs_density()) {
      const GridSummary grid = read_header(scene, volume, volume.density, grids);
      fact = {grid.active_voxels == 0, grid.active_voxels};
      if (!fact.empty)
        bounds.extend(visible_bounds(grid, volume.transform));
    }
    fact.glowing_voxels = count_glowing_voxels(scene, volume, bounds, grids);
    facts.push_back(fact);
  }
  const Camera camera(scene.camera, scene.image, {});
  for (VolumeFacts& fact : facts)
    fact.in_view = (!fact.empty || fact.glowing_voxels > 0) &&
                   (!scene.moments.empty() || camera.may_see(bounds));
  RenderPlan plan = plan_stages(scene, facts);
  plan.surface_files = surface_files(scene);
  for (const SurfaceFile& file : plan.surface_files)
    plan.surface_bytes += file.bytes;
  return plan;
}

} // namespace vdbeam
