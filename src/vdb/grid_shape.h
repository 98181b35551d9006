#pragma once

#include "math/affine.h"
#include "vdb/vdb_reader.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Voxels that a leaf of 8^3 or a tile of a grid has active, both corners included.
struct ActiveBox {
  std::array<std::int32_t, 3> lower, upper;
  /// Mask of a leaf's 4^3 blocks of 2^3 voxels that have active voxels, x-major.
  std::uint64_t blocks = ~std::uint64_t{0};
};

/// Where a grid has voxels, as the topology of its tree says; no values are read.
struct GridShape {
  std::uint64_t active_voxels = 0;
  std::uint64_t node_bytes = 0;  ///< of the tree's inner nodes in OpenVDB
  std::uint64_t value_bytes = 4; ///< of a voxel in OpenVDB
  std::vector<ActiveBox> leaves, tiles;
  /// Sum of the voxels' values, as far as they are above 0; below 0 where values were not read.
  double value_sum = -1;
  std::uint64_t leaf_count = 0; ///< of the tree: `leaves` lacks those without any value above 0
};

/// Reads the topology of a density or emission grid, in a fraction of the time that the grid takes,
/// and the values of a small grid of fog. Throws as read_density_grid.
GridShape read_grid_shape(const std::string& path, const std::string& grid_name,
                          const ReadLimits& limits = {});

/// The cells of 8^3 of a field that become bricks. Estimates of memory follow a grid through the
/// steps of its preparation by this set.
class CellSet {
public:
  CellSet() = default;
  /// The bricks of a grid: a brick has one layer of its upper neighbours. `scale`: voxels
  /// of the field per voxel of the grid, and `reach`: voxels of the field by which values spread; 1
  /// and 0 for the grid itself. `wanted`: only these voxels count.
  CellSet(const GridShape& shape, int scale, int reach,
          const std::optional<WantedBox::Voxels>& wanted = {});

  /// Whether the cell of these coordinates [cells of the field's lattice] becomes a brick.
  bool holds(const Vec3d& cell) const;
  /// Whether the field may be above 0 there: of the grid itself, by its voxels, and else as
  /// `holds`.
  bool may_hold(const Vec3d& cell) const;
  /// Where the set lies, in the same coordinates.
  Boxd bounds() const;
  /// Bricks of the field.
  std::uint64_t count() const;
  /// Columns of cells along each axis that hold a brick: what its shadow covers.
  Vec3d columns() const;
  /// Entries of the field's tables.
  std::uint64_t cells() const;
  bool empty() const { return marks_.empty(); }
  /// The cells that lie between `lower` and `upper` cells from a marked one, both included.
  CellSet spread(const Vec3<int>& lower, const Vec3<int>& upper) const;

private:
  std::size_t offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * static_cast<std::size_t>(counts_.y) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(counts_.z) +
           static_cast<std::size_t>(k);
  }
  void mark(const Vec3<int>& a, const Vec3<int>& b, const ActiveBox* tile);
  void spread_along(int axis, int lower, int upper);

  Vec3<std::int64_t> lower_; ///< of the first mark, in marks
  Vec3<int> counts_;
  std::vector<std::uint8_t> marks_;
  std::vector<std::uint64_t> blocks_; ///< by mark, as ActiveBox has them; empty where not known
  int width_ = 1; ///< of a mark, in cells: more than 1 where the table would be too large
};

} // namespace vdbeam
