#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace vdbeam {

/// The OpenVDB side of reading. Everything here may hang, crash or throw on a malformed file, and
/// uses no thread but its own, so that it can run in a forked child process.

/// How `write_raw_grid` lays a grid out: this header, padding up to `values_offset`, leaf_count x
/// 512 floats, leaf_count x 3 int32 origins, tile_count x RawTile.
struct RawGridHeader {
  static constexpr std::size_t values_offset = 4096;
  static constexpr std::uint64_t magic_number = 0x76646265616d3031;

  std::uint64_t magic = magic_number;
  std::uint64_t leaf_count = 0;
  std::uint64_t tile_count = 0;
  std::uint64_t active_voxels = 0;
  std::array<double, 12> index_to_world{}; ///< row-major 3x4
  std::uint32_t level_set = 0;
};

/// Must be called once, before any fork: registers OpenVDB's grid types.
void prepare_openvdb();

/// Reads one grid and writes it to `descriptor`. Throws InputError (no such grid, unsupported type,
/// class, map or background), and whatever OpenVDB throws.
void write_raw_grid(const std::string& path, const std::string& grid_name, int descriptor);

} // namespace vdbeam
