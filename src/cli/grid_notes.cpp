#include "cli/grid_notes.h"

#include "scene/default_scene.h"
#include "vdb/density_kind.h"
#include "vdb/vdb_names.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam::cli {
namespace {

void add_bad_values(const GridSummary& grid, std::vector<std::string>& lines) {
  const GridRepairs& bad = grid.bad_values;
  const std::pair<std::uint64_t, const char*> counts[] = {{bad.nan, "NaN"},
                                                          {bad.infinite, "infinite"}};
  for (const auto& [count, name] : counts)
    if (count > 0)
      lines.push_back(
          fmt::format("{}: {} {} values; as density they count as 0", grid.name, count, name));
  if (bad.negative > 0 && grid.name.starts_with("density"))
    lines.push_back(
        fmt::format("{}: {} negative values; they count as 0", grid.name, bad.negative));
}

void add_shape(const GridSummary& grid, std::vector<std::string>& lines) {
  if (grid.active_voxels == 0)
    lines.push_back(fmt::format("{}: is empty", grid.name));
  if (is_level_set(grid))
    lines.push_back(
        fmt::format("{}: is a level set; its inside is rendered as density 1", grid.name));
  if (const auto why = why_no_density(kind_of(grid)); why && is_scalar(grid))
    lines.push_back(fmt::format("{}: cannot be rendered as density: it {}", grid.name, *why));
  if (grid.active_voxels > 0 && is_scalar(grid) && grid.minimum == 0 && grid.maximum == 0)
    lines.push_back(fmt::format("{}: all its values are 0", grid.name));
  const auto [low, high] =
      std::minmax({grid.voxel_size[0], grid.voxel_size[1], grid.voxel_size[2]});
  if (low > 0 && high / low > 10)
    lines.push_back(
        fmt::format("{}: voxels are {:.3g} times longer than wide", grid.name, high / low));
}

/// Note about a grid that can colour the volume.
std::string color_text(const std::vector<GridSummary>& grids) {
  for (const char* name : color_grid_names)
    for (const GridSummary& grid : grids)
      if (grid.name == name && grid.value_type == "vec3s")
        return fmt::format("; color_grid = \"{}\" colours it", name);
  return "";
}

} // namespace

bool is_scalar(const GridSummary& grid) {
  return grid.value_type == "float" || grid.value_type == "half" || grid.value_type == "double";
}

std::string rendered_text(const std::string& file, const std::vector<GridSummary>& grids) {
  try {
    const Scene scene = make_default_scene(file, {grids}, {});
    const VolumeSettings& volume = scene.volumes.front();
    for (const GridSummary& grid : grids)
      if (const auto why = why_no_density(kind_of(grid)); why && grid.name == volume.density)
        return fmt::format("nothing: grid \"{}\" {}", grid.name, *why);
    const EmissionSettings& emission = volume.emission;
    const std::string glow =
        !volume.glows()
            ? ""
            : fmt::format(", \"{}\" glows with strength {}",
                          emission.intensity.empty() ? emission.temperature : emission.intensity,
                          emission.scale);
    return fmt::format("grid \"{}\", with extinction {}{}{} (vdbeam init shows the whole scene)",
                       volume.density, volume.extinction, glow, color_text(grids));
  } catch (const InputError& error) {
    return fmt::format("nothing: {}", error.what());
  }
}

std::vector<std::string> suspicious(const std::vector<GridSummary>& grids) {
  std::vector<std::string> lines;
  for (const GridSummary& grid : grids) {
    add_bad_values(grid, lines);
    add_shape(grid, lines);
  }
  return lines;
}

} // namespace vdbeam::cli
