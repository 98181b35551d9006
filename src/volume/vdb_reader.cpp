#include "volume/vdb_reader.h"

#include "vdbeam/error.h"
#include "volume/brick_builder.h"
#include "volume/mapped_file.h"
#include "volume/raw_grid.h"
#include "volume/vdb_parse.h"

#include <fmt/format.h>
#include <openvdb/version.h>

#include <cstring>

namespace vdbeam {

namespace {

/// Trusts nothing that comes from the parser: a malformed file may have broken it without a crash.
RawGrid view_raw_grid(const std::string& label, const MappedFile& file, RawGridHeader& header) {
  const auto corrupt = [&label](bool is_corrupt) {
    if (is_corrupt)
      throw FrameError(label + ": the file is corrupt");
  };
  corrupt(file.size() < RawGridHeader::values_offset);
  std::memcpy(&header, file.data(), sizeof header);
  const std::uint64_t leaf_bytes = leaf_size * sizeof(float) + 3 * sizeof(std::int32_t);
  const std::uint64_t payload = file.size() - RawGridHeader::values_offset;
  corrupt(header.magic != RawGridHeader::magic_number);
  corrupt(header.leaf_count > payload / leaf_bytes || header.tile_count > payload);
  corrupt(header.leaf_count * leaf_bytes + header.tile_count * sizeof(RawTile) != payload);

  RawGrid grid;
  grid.leaf_count = header.leaf_count;
  std::byte* values = file.data() + RawGridHeader::values_offset;
  std::byte* origins = values + grid.leaf_count * leaf_size * sizeof(float);
  grid.leaf_values = reinterpret_cast<float*>(values);
  grid.leaf_origins = reinterpret_cast<const std::int32_t*>(origins);
  grid.level_set = header.level_set != 0;
  grid.tiles.resize(header.tile_count);
  if (!grid.tiles.empty())
    std::memcpy(grid.tiles.data(), origins + grid.leaf_count * 3 * sizeof(std::int32_t),
                header.tile_count * sizeof(RawTile));

  for (std::size_t leaf = 0; leaf < grid.leaf_count; ++leaf) {
    const std::int32_t* origin = grid.leaf_origins + 3 * leaf;
    corrupt(origin[0] % leaf_width != 0 || origin[1] % leaf_width != 0 ||
            origin[2] % leaf_width != 0);
    corrupt(leaf > 0 && !std::lexicographical_compare(origin - 3, origin, origin, origin + 3));
  }
  for (const RawTile& tile : grid.tiles)
    corrupt(tile.width < leaf_width || (tile.width & (tile.width - 1)) != 0 ||
            tile.origin[0] % leaf_width != 0 || tile.origin[1] % leaf_width != 0 ||
            tile.origin[2] % leaf_width != 0);
  return grid;
}

std::string repairs_note(const std::string& label, const GridRepairs& repairs) {
  std::string list;
  const auto add = [&list](std::uint64_t count, const char* what) {
    if (count > 0)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, what);
  };
  add(repairs.nan, "NaN");
  add(repairs.infinite, "infinite");
  add(repairs.negative, "negative");
  return fmt::format("{}: values replaced by 0: {}", label, list);
}

} // namespace

DensityGrid read_density_grid(const std::string& path, const std::string& grid_name,
                              const ReadLimits& limits) {
  const std::string label = fmt::format("{}: grid \"{}\"", path, grid_name);
  prepare_openvdb();
  MappedFile file;
  {
    const Descriptor memory = create_memory_file();
    write_raw_grid(path, grid_name, memory.get());
    file = MappedFile(memory.get());
  }
  RawGridHeader header;
  RawGrid raw = view_raw_grid(label, file, header);
  raw.release = [&file](std::size_t leaves) {
    file.release_front(RawGridHeader::values_offset + leaves * leaf_size * sizeof(float));
  };
  BrickedGrid bricked = build_bricks(raw, label, limits.bytes);

  DensityGrid grid;
  grid.field = std::move(bricked.field);
  grid.repairs = bricked.repairs;
  grid.active_voxels = header.active_voxels;
  const auto& m = header.index_to_world;
  grid.index_to_world.rows = {Vec3d{m[0], m[1], m[2]}, Vec3d{m[4], m[5], m[6]},
                              Vec3d{m[8], m[9], m[10]}};
  grid.index_to_world.translation = {m[3], m[7], m[11]};
  if (header.level_set)
    grid.notes.push_back(label + ": is a level set, made a fog volume");
  if (grid.repairs.nan + grid.repairs.infinite + grid.repairs.negative > 0)
    grid.notes.push_back(repairs_note(label, grid.repairs));
  if (grid.field.empty())
    grid.notes.push_back(label + ": is empty, nothing to render");
  return grid;
}

std::string vdb_library_version() {
  return fmt::format("OpenVDB {}.{}.{}", OPENVDB_LIBRARY_MAJOR_VERSION_NUMBER,
                     OPENVDB_LIBRARY_MINOR_VERSION_NUMBER, OPENVDB_LIBRARY_PATCH_VERSION_NUMBER);
}

} // namespace vdbeam
