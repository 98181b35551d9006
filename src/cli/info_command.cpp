#include "cli/commands.h"
#include "cli/grid_notes.h"
#include "cli/surface_info.h"
#include "console/streams.h"
#include "geometry/mesh_reader.h"
#include "machine/input_file.h"
#include "text/frame_range.h"
#include "text/missing_file.h"
#include "text/printable.h"
#include "text/text.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <set>

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
  std::string text = fmt::format("  {}\n    type        {}, {}\n", printable_line(grid.name),
                                 grid.value_type, grid.grid_class);
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
      fmt::format("{}: {}\n", printable_line(file), count_text(grids.size(), "grid"));
  for (const GridSummary& grid : grids)
    text += grid_text(grid);
  text += fmt::format("  rendered      {}\n", printable_line(rendered_text(file, grids)));
  for (const std::string& line : suspicious(grids))
    text += fmt::format("  looks wrong   {}\n", printable_line(line));
  print_text(text);
}

/// The VDBs of a folder, in the order of their names.
std::vector<std::string> volumes_in(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error))
    if (entry->path().extension() == ".vdb")
      files.push_back(entry->path().string());
  if (error)
    throw InputError(
        fmt::format("{}: the folder cannot be read: {}", one_line(folder), error.message()));
  if (files.empty())
    throw InputError(one_line(folder + ": is a folder without a .vdb file"));
  std::sort(files.begin(), files.end());
  return files;
}

/// The first, the middle and the last file of a sequence.
std::vector<std::string> samples_of(const std::string& pattern) {
  const std::vector<int> frames = frames_on_disk(pattern);
  if (frames.empty())
    throw InputError(missing_file_text(pattern));
  const std::set<int> shown{frames.front(), frames[frames.size() / 2], frames.back()};
  print_text(fmt::format("{}: frames {}; shown {} {}\n", pattern, format_frame_range(frames),
                         shown.size() == 1 ? "is" : "are",
                         format_frame_range({shown.begin(), shown.end()})));
  std::vector<std::string> files;
  for (const int frame : shown)
    files.push_back(substitute_frame(pattern, frame));
  return files;
}

/// The files that a word of the command line stands for.
std::vector<std::string> files_of(const std::string& word) {
  std::error_code error;
  if (std::filesystem::is_directory(word, error))
    return volumes_in(word);
  if (is_there(word))
    return {word};
  if (has_frame_pattern(word))
    return samples_of(word);
  throw InputError(missing_file_text(word));
}

/// One unreadable file does not hide the others.
int run_info(const InfoOptions& options) {
  int code = 0;
  std::vector<std::string> files;
  for (const std::string& word : options.files) {
    try {
      const std::vector<std::string> found = files_of(word);
      files.insert(files.end(), found.begin(), found.end());
    } catch (const Error& error) {
      if (options.files.size() == 1)
        throw;
      log_line(error.what());
      code = static_cast<int>(error.code());
    }
  }
  for (const std::string& file : files) {
    try {
      if (is_mesh_file(file))
        print_text(mesh_info(file));
      else if (is_picture_file(file))
        print_text(picture_info(file));
      else
        print_file(file);
    } catch (const Error& error) {
      if (files.size() == 1 && code == 0)
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
  app.add_option("files", options->files,
                 "VDBs, meshes (OBJ, PLY, glTF), images (EXR, HDR, PNG, JPEG), folders of VDBs, or "
                 "sequences like smoke.####.vdb")
      ->required()
      ->option_text("FILE...");
  app.footer(R"(Examples:
  vdbeam info cloud.vdb
  vdbeam info smoke/*.vdb
  vdbeam info ship.obj rust.png                 triangles, bounds, UV; size, colours, range
  vdbeam info smoke/smoke.####.vdb              the first, the middle and the last frame)");
  return [options] { return run_info(*options); };
}

} // namespace vdbeam::cli
