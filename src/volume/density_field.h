#pragma once

#include "math/affine.h"
#include "math/shared_array.h"
#include "volume/density_layers.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace vdbeam {

/// Voxels of a cell, and lattice points of its brick, along an axis.
inline constexpr int cell_width = 8, brick_width = cell_width + 1;

/// A scalar field on an integer lattice with OpenVDB's convention: voxel i sits at index i, values
/// in between are trilinear, and outside the stored voxels the field is 0 (so a border voxel ramps
/// to 0 over one voxel).
///
/// Storage: the lattice box is cut in cells of 8^3; each cell is empty, uniform, or a *brick* of
/// 9^3 values (its own 8^3 and one apron layer at the upper sides), so that every trilinear sample
/// reads one brick and the largest value of a cell's brick bounds every sample in the cell.
///
/// Copies share the values, which never change.
///
/// "Local" coordinates are index coordinates less `origin()`, so they are never negative inside and
/// small enough for single precision; cell (i, j, k) covers local [8i, 8i + 8) etc.
class DensityField {
public:
  static constexpr int brick_size = brick_width * brick_width * brick_width;
  static constexpr std::int32_t empty_cell = -1;   ///< index table: the whole cell is 0
  static constexpr std::int32_t uniform_base = -2; ///< index table: -2 - n is uniform value n

  DensityField() = default;
  /// Takes the parts over. `cells` is x-major ((i * cells_y + j) * cells_z + k); `bricks` holds
  /// brick_size values per brick, x-major ((x * 9 + y) * 9 + z).
  DensityField(Vec3<std::int64_t> origin, Vec3<int> cell_counts, std::vector<std::int32_t> cells,
               std::vector<float> bricks, std::vector<float> uniform_values);

  bool empty() const { return cells_.empty(); }
  /// Index coordinates of local (0, 0, 0).
  const Vec3<std::int64_t>& origin() const { return origin_; }
  const Vec3<int>& cell_counts() const { return cell_counts_; }
  /// Entry of the index table of cell (i, j, k): a brick number, empty_cell, or uniform_base - n.
  std::int32_t cell(int i, int j, int k) const { return cells_[cell_offset(i, j, k)]; }
  std::size_t cell_offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * cell_counts_.y + j) * cell_counts_.z + k;
  }
  const float* brick(std::int32_t number) const {
    return bricks_.data() + static_cast<std::size_t>(number) * brick_size;
  }
  float uniform_value(std::int32_t entry) const { return uniform_values_[uniform_base - entry]; }
  /// Largest value that any sample inside the cell can take.
  float cell_maximum(std::size_t offset) const { return maxima_[offset]; }
  float maximum() const { return maximum_; }
  /// Replaces greater values by `most` > 0; returns how many values of bricks and uniform cells
  /// that were.
  std::size_t limit_values(float most);

  /// Trilinear sample at local coordinates; 0 outside.
  float sample(const Vec3f& local) const;
  /// The nearest point for which `sample` reads a cell.
  Vec3f nearest(const Vec3f& local) const;

  /// Tight box of the non-empty cells, in local coordinates, shrunk to where the field is not 0.
  const Boxf& occupied() const { return occupied_; }

  /// Null where the density does not change along y alone.
  const DensityLayers* layers() const { return layers_.get(); }

  /// The same for copies, and for nothing else.
  const void* values() const { return maxima_.data(); }
  std::size_t brick_count() const { return bricks_.size() / brick_size; }
  std::size_t bytes() const;

private:
  Vec3<std::int64_t> origin_;
  Vec3<int> cell_counts_;
  Vec3f limit_; ///< upper end of the cells, local
  SharedArray<std::int32_t> cells_;
  SharedArray<float> bricks_;
  SharedArray<float> uniform_values_;
  SharedArray<float> maxima_;
  float maximum_ = 0;
  Boxf occupied_;
  std::shared_ptr<const DensityLayers> layers_;
};

/// The trilinear value between the lattice points at `p` and one further along each axis.
inline float sample_cube(const float* p, float fx, float fy, float fz) {
  constexpr int width = brick_width;
  const auto along_z = [fz](const float* q) { return q[0] + fz * (q[1] - q[0]); };
  const float c00 = along_z(p), c01 = along_z(p + width), c10 = along_z(p + width * width),
              c11 = along_z(p + width * width + width);
  const float c0 = c00 + fy * (c01 - c00), c1 = c10 + fy * (c11 - c10);
  return c0 + fx * (c1 - c0);
}

inline float DensityField::sample(const Vec3f& local) const {
  if (!(local.x >= 0 && local.y >= 0 && local.z >= 0 && local.x < limit_.x && local.y < limit_.y &&
        local.z < limit_.z))
    return 0;
  const int i = static_cast<int>(local.x), j = static_cast<int>(local.y),
            k = static_cast<int>(local.z);
  const std::int32_t entry = cell(i >> 3, j >> 3, k >> 3);
  if (entry >= 0)
    return sample_cube(brick(entry) + ((i & 7) * brick_width + (j & 7)) * brick_width + (k & 7),
                       local.x - static_cast<float>(i), local.y - static_cast<float>(j),
                       local.z - static_cast<float>(k));
  return entry == empty_cell ? 0 : uniform_value(entry);
}

inline Vec3f DensityField::nearest(const Vec3f& local) const {
  const auto below = [](float limit) { return std::nextafter(limit, 0.0f); };
  return min(max(local, Vec3f(0)), Vec3f{below(limit_.x), below(limit_.y), below(limit_.z)});
}

} // namespace vdbeam
