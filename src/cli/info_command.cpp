#include "cli/commands.h"
#include "cli/grid_notes.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "volume/vdb_reader.h"

#include <cstdio>
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

void print_map(const GridSummary& grid) {
  fmt::print("    map         {}, voxel {:.6g} x {:.6g} x {:.6g}\n", grid.map_type,
             grid.voxel_size[0], grid.voxel_size[1], grid.voxel_size[2]);
}

void print_grid(const GridSummary& grid) {
  fmt::print("  {}\n    type        {}, {}\n", grid.name, grid.value_type, grid.grid_class);
  print_map(grid);
  fmt::print("    voxels      {} active, {} leaves, {} tiles\n", grid.active_voxels,
             grid.leaf_count, grid.tile_count);
  if (grid.active_voxels == 0)
    return;
  fmt::print("    index       ({}, {}, {}) to ({}, {}, {})\n", grid.index_lower.x,
             grid.index_lower.y, grid.index_lower.z, grid.index_upper.x, grid.index_upper.y,
             grid.index_upper.z);
  fmt::print("    world       {} to {}\n", vector_text(grid.world_bounds.lower),
             vector_text(grid.world_bounds.upper));
  if (is_scalar(grid))
    fmt::print("    values      {:.6g} to {:.6g}, mean {:.6g}, background {:.6g}\n", grid.minimum,
               grid.maximum, grid.mean, grid.background);
}

void print_file(const std::string& file) {
  const std::vector<GridSummary> grids = summarize_vdb(file);
  fmt::print("{}: {} {}\n", file, grids.size(), grids.size() == 1 ? "grid" : "grids");
  for (const GridSummary& grid : grids)
    print_grid(grid);
  fmt::print("  rendered      {}\n", rendered_text(file, grids));
  for (const std::string& line : suspicious(grids))
    fmt::print("  looks wrong   {}\n", line);
  std::fflush(stdout);
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
      fmt::print(stderr, "{}\n", error.what());
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
