#include "render/plan.h"
#include "render/surface_files.h"
#include "transport/camera.h"
#include "volume/vdb_reader.h"

namespace vdbeam {
namespace {

/// World bounds of all that a grid can make visible: a border voxel ramps to 0 over one voxel.
Boxd visible_bounds(const GridSummary& grid, const std::array<double, 12>& m) {
  const Affine map = Affine::from_matrix(m).after(grid.index_to_world);
  return map.bounds({Vec3d(grid.index_lower) - Vec3d(1), Vec3d(grid.index_upper) + Vec3d(1)});
}

/// Voxels of the grids that a volume's emission is made from, as their headers say; 0 where one of
/// them is empty.
std::uint64_t count_glowing_voxels(const VolumeSettings& volume, Boxd& bounds) {
  std::uint64_t voxels = 0;
  if (!volume.glows())
    return voxels;
  for (const std::string& name : {volume.emission.temperature, volume.emission.intensity}) {
    if (name.empty())
      continue;
    const GridSummary grid = read_grid_header(volume.file, name);
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
  for (const VolumeSettings& volume : scene.volumes) {
    VolumeFacts fact{true, 0};
    if (volume.needs_density()) {
      const GridSummary grid = read_grid_header(volume.file, volume.density);
      fact = {grid.active_voxels == 0, grid.active_voxels};
      if (!fact.empty)
        bounds.extend(visible_bounds(grid, volume.transform));
    }
    fact.glowing_voxels = count_glowing_voxels(volume, bounds);
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
