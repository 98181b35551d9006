#pragma once

#include "machine/mapped_file.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace vdbeam {

/// A grid as it lies in the file, free of OpenVDB's types: 8^3 leaves, and tiles of one value.

inline constexpr int leaf_width = 8;
inline constexpr int leaf_size = leaf_width * leaf_width * leaf_width;

/// A cube of one value: `width` voxels (a power of two, at least 8) from `origin` on.
struct RawTile {
  std::array<std::int32_t, 3> origin;
  std::int32_t width;
  float value;
};

/// Leaves in ascending order of their origins (x, then y, then z), none twice; values x-major.
struct RawGrid {
  std::size_t leaf_count = 0;
  const std::int32_t* leaf_origins = nullptr; ///< 3 per leaf, multiples of 8
  float* leaf_values = nullptr;               ///< leaf_size per leaf; mended in place
  std::vector<RawTile> tiles;
  bool level_set = false; ///< values are signed distances, negative inside
  /// Called with how many leaves from the first on are not needed any more (ever more of them).
  std::function<void(std::size_t)> release = [](std::size_t) {};
};

/// How a grid travels from the reader process: this header, padding up to `values_offset`,
/// leaf_count x 512 floats, leaf_count x 3 int32 origins, tile_count x RawTile.
struct RawGridHeader {
  static constexpr std::size_t values_offset = 4096;
  static constexpr std::uint64_t magic_number = 0x76646265616d3031;

  std::uint64_t magic = magic_number;
  std::uint64_t leaf_count = 0;
  std::uint64_t tile_count = 0;
  std::uint64_t active_voxels = 0;
  std::int64_t declared_voxels = -1; ///< as the file's statistics say, below 0 where they do not
  std::array<double, 12> index_to_world{}; ///< row-major 3x4
  std::uint32_t level_set = 0;
  std::uint32_t staggered = 0; ///< of velocities: each component lies on its faces of the voxel
  std::uint32_t from_mantaflow = 0;
  std::uint32_t cropped = 0;    ///< leaves and tiles were left out that nothing needs
  std::array<char, 256> name{}; ///< of the grid in the file, ended by 0, or as much of it
};

/// The grid in a file of that layout; it refers to the file's memory. Trusts nothing, since a
/// malformed VDB may have broken the process that wrote it: throws FrameError, opening with
/// `label`, where the sizes, the order of the leaves or the tiles' shapes are not what they must
/// be.
RawGrid view_raw_grid(const std::string& label, MappedFile& file, RawGridHeader& header);

} // namespace vdbeam
