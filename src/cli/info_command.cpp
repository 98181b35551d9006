#include "cli/commands.h"
#include "cli/grid_notes.h"
#include "cli/streams.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "volume/vdb_reader.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

struct InfoOptions {
  std::vector<std::string> files;
};

std::string vector_text(const Vec3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string map_text(const GridSummary& grid) {
  return fmt::format("    map         {}, voxel {:.6g} x {:.6g} x {:.6g}\n", grid.map_type,
                     grid.voxel_size[0], grid.voxel_size[1], grid.voxel_size[2]);
}

std::string grid_text(const GridSummary& grid) {
  std::string text =
      fmt::format("  {}\n    type        {}, {}\n", grid.name, grid.value_type, grid.grid_class);
  text += map_text(grid);
  text += fmt::format("    voxels      {} active, {} leaves, {} tiles\n", grid.active_voxels,
                      grid.leaf_count, grid.tile_count);
  if (grid.active_voxels == 0)
    return text;
  text += fmt::format("    index       ({}, {}, {}) to ({}, {}, {})\n", grid.index_lower.x,
                      grid.index_lower.y, grid.index_lower.z, grid.index_upper.x,
                      grid.index_upper.y, grid.index_upper.z);
  text += fmt::format("    world       {} to {}\n", vector_text(grid.world_bounds.lower),
                      vector_text(grid.world_bounds.upper));
  if (is_scalar(grid))
    text += fmt::format("    values      {:.6g} to {:.6g}, mean {:.6g}, background {:.6g}\n",
                        grid.minimum, grid.maximum, grid.mean, grid.background);
  return text;
}

void print_file(const std::string& file) {
  const std::vector<GridSummary> grids = summarize_vdb(file);
  std::string text =
      fmt::format("{}: {} {}\n", file, grids.size(), grids.size() == 1 ? "grid" : "grids");
  for (const GridSummary& grid : grids)
    text += grid_text(grid);
  text += fmt::format("  rendered      {}\n", rendered_text(file, grids));
  for (const std::string& line : suspicious(grids))
    text += fmt::format("  looks wrong   {}\n", line);
  print_output(text);
}

/// One unreadable file does not hide the others.
int run_info(const InfoOptions& options) {
  int code = 0;
  for (const std::string& file : options.files) {
    try {
      print_file(file);
    } catch (const Error& error) {
      if (options.files.size() == 1)
        throw;
      log_line(error.what());
      code = code == 0 ? static_cast<int>(error.code()) : code;
    }
  }
  return code;
}

} // namespace

CommandRun add_info(CLI::App& app) {
  const auto options = std::make_shared<InfoOptions>();
  app.add_option("files", options->files, "VDB files")->required()->option_text("FILE...");
  app.footer(R"(Examples:
  vdbeam info cloud.vdb
  vdbeam info smoke/*.vdb)");
  return [options] { return run_info(*options); };
}

} // namespace vdbeam::cli
