#pragma once

#include "math/affine.h"
#include "vdbeam/volume_edits.h"
#include "volume/vdb_reader.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdbeam {

/// Velocities on an integer lattice, trilinear between its points. Where there is none, or one that
/// is not to be trusted, the mean of the cell of 8^3 around is taken, and in cells without any the
/// mean of the cells that are nearest: what moves must be able to leave the place where it was.
class VelocityField {
public:
  static constexpr int cell_width = 8;

  struct Values {
    Affine index_to_world;
    bool staggered = false;    ///< component c lies half a voxel before its voxel along axis c
    bool from_mantaflow = false;
    Vec3<std::int64_t> origin; ///< index of the first cell's first voxel, a multiple of 8
    Vec3<int> cells;
    std::vector<std::int32_t> table; ///< brick of each cell (x-major), or -1
    std::vector<Vec3f> bricks;       ///< 8^3 per brick, x-major; NaN where there is none
    std::vector<Vec3f> means;        ///< per cell: NaN, or what a tile says
  };
  /// Velocities that are longer than `longest` count as missing.
  VelocityField(Values values, double longest);

  const Affine& index_to_world() const { return values_.index_to_world; }
  bool from_mantaflow() const { return values_.from_mantaflow; }
  /// At a point in index coordinates, in the grid's own units.
  Vec3d sample(const Vec3d& index) const;
  /// Voxels whose velocity was too long or not a number.
  std::uint64_t outliers() const { return outliers_; }
  bool empty() const { return values_.table.empty(); }

private:
  void find_means(double longest);
  void fill_cells_without();
  std::size_t cell_offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * values_.cells.y + j) * values_.cells.z + k;
  }
  /// The velocity at a lattice point, from the first cell's first voxel on.
  const Vec3f& at(std::int64_t i, std::int64_t j, std::int64_t k) const;
  Vec3d trilinear(const Vec3d& local) const;

  Values values_;
  std::uint64_t outliers_ = 0;
};

/// What a velocity's numbers mean: lengths per second of the grid's index space or of the world,
/// times a factor.
struct VelocityScale {
  bool index = false;
  double factor = 1;
};
VelocityScale scale_of(const VelocitySettings& settings, bool from_mantaflow);

/// Reads the velocity of a VDB; null where settings.grid is "auto" and the file has none. What
/// would cross the whole grid within a frame is an outlier. Throws as read_density_grid.
std::shared_ptr<const VelocityField> read_velocity(const std::string& path,
                                                   const VelocitySettings& settings,
                                                   const ReadLimits& limits = {});

} // namespace vdbeam
