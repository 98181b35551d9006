#pragma once

#include "math/affine.h"
#include "vdb/vdb_reader.h"
#include "vdbeam/volume_edits.h"
#include "volume/density_field.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// Vectors (velocities, colours) on an integer lattice, trilinear between its points; staggered
/// ones are brought to the points by the mean of both faces. Where there is none, or one that is
/// not to be trusted, the mean of the cell of 8^3 around is taken, and in cells without any the
/// mean of the cells that are nearest: what moves must be able to leave the place where it was.
class VectorField {
public:
  struct Values {
    Affine index_to_world;
    bool staggered = false; ///< component c lies half a voxel before its voxel along axis c
    bool from_mantaflow = false;
    Vec3<std::int64_t> origin; ///< index of the first cell's first voxel, a multiple of 8
    Vec3<int> cells;
    std::vector<std::int32_t> table; ///< brick of each cell (x-major), or -1
    std::vector<Vec3f> bricks;       ///< 8^3 per brick, x-major; NaN where there is none
    std::vector<Vec3f> means;        ///< per cell: NaN, or what a tile says
  };
  /// Vectors that are longer than `longest` count as missing.
  VectorField(Values values, double longest);

  const Affine& index_to_world() const { return index_to_world_; }
  bool from_mantaflow() const { return from_mantaflow_; }
  /// At a point in index coordinates, in the grid's own units.
  Vec3d sample(const Vec3d& index) const;
  /// Bounds of all vectors in a box of index coordinates, and of some around it.
  Boxf bounds(const Boxd& index) const;
  /// Voxels whose vector was too long or not a number.
  std::uint64_t outliers() const { return outliers_; }
  bool empty() const { return table_.empty(); }

private:
  void find_means(Values& values, double longest);
  void build_bricks(const Values& values);
  void find_bounds();

  Affine index_to_world_;
  bool from_mantaflow_ = false;
  Vec3<std::int64_t> origin_;
  Vec3<int> cells_;
  std::vector<std::int32_t> table_; ///< brick of each cell; -1: its mean everywhere
  std::vector<Vec3f> bricks_, means_;
  std::vector<Boxf> cell_bounds_; ///< of the vectors in each cell
  std::uint64_t outliers_ = 0;
};

} // namespace vdbeam
