#pragma once

#include <cstdint>
#include <string>

namespace vdbeam {

/// How a grid's shape travels from the reader process: this header, then an ActiveBox for each leaf
/// and each tile.
struct ShapeHeader {
  std::uint64_t leaf_count = 0, tile_count = 0, active_voxels = 0, node_bytes = 0, value_bytes = 4;
  std::uint64_t tree_leaves = 0;
  double value_sum = -1; ///< as GridShape has it
};

/// Reads the topology of one grid and writes its shape to `descriptor`, in a child process as
/// vdb_parse.h describes. Throws as write_raw_grid.
void write_shape(const std::string& path, const std::string& grid_name, int descriptor);

} // namespace vdbeam
