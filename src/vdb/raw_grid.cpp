#include "vdb/raw_grid.h"

#include "vdbeam/error.h"

#include <algorithm>
#include <cstring>

namespace vdbeam {

RawGrid view_raw_grid(const std::string& label, MappedFile& file, RawGridHeader& header) {
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

} // namespace vdbeam
