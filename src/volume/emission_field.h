#pragma once

#include "math/stop_token.h"
#include "volume/density_field.h"

#include <functional>

namespace vdbeam {

/// Light that a volume sends out, RGB on the lattice of a DensityField and stored like it: cells of
/// 8^3 that are empty, uniform or a brick of 9^3 values, trilinear in between, 0 outside.
class EmissionField {
public:
  /// Emission of a lattice point with value `value` at `local`.
  using Law = std::function<Rgb(float value, const Vec3f& local)>;

  EmissionField() = default;
  /// The cells of `shape` that are not empty, with `law` at their lattice points. `law` must be 0
  /// where the value is, and may be called from several threads. `uniform`: it does not depend on
  /// the place, so that uniform cells stay so. Cells that are darker than 1e-8 of the brightest
  /// become empty. Throws Stopped.
  EmissionField(const DensityField& shape, const Law& law, bool uniform,
                const StopToken* stop = nullptr);

  bool empty() const { return occupied_.empty(); }
  const Vec3<std::int64_t>& origin() const { return origin_; }
  const Vec3<int>& cell_counts() const { return cell_counts_; }
  std::int32_t cell(int i, int j, int k) const { return cells_[cell_offset(i, j, k)]; }
  std::size_t cell_offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * cell_counts_.y + j) * cell_counts_.z + k;
  }
  const Rgb* brick(std::int32_t number) const {
    return bricks_.data() + static_cast<std::size_t>(number) * DensityField::brick_size;
  }
  const Rgb& uniform_value(std::int32_t entry) const {
    return uniform_values_[static_cast<std::size_t>(DensityField::uniform_base - entry)];
  }
  /// The value in a cell that is not empty, at cell-local coordinates, 0 <= x, y, z <= 8.
  Rgb sample_cell(std::int32_t entry, const Vec3f& p) const;
  /// Tight box of the cells that are not empty, local.
  const Boxf& occupied() const { return occupied_; }
  std::size_t brick_count() const { return bricks_.size() / DensityField::brick_size; }
  std::size_t bytes() const;
  /// Bytes that the field of a shape takes at most.
  static std::uint64_t bytes_of(const DensityField& shape, bool uniform);

private:
  void number_cells(const DensityField& shape, bool uniform);
  void drop_dark_cells();

  Vec3<std::int64_t> origin_;
  Vec3<int> cell_counts_;
  std::vector<std::int32_t> cells_; ///< as in DensityField
  std::vector<Rgb> bricks_;
  std::vector<Rgb> uniform_values_;
  Boxf occupied_;
};

inline Rgb EmissionField::sample_cell(std::int32_t entry, const Vec3f& p) const {
  if (entry < 0)
    return uniform_value(entry);
  constexpr int width = brick_width;
  const int i = std::min(static_cast<int>(p.x), 7), j = std::min(static_cast<int>(p.y), 7),
            k = std::min(static_cast<int>(p.z), 7);
  const float fx = p.x - static_cast<float>(i), fy = p.y - static_cast<float>(j),
              fz = p.z - static_cast<float>(k);
  const Rgb* corner = brick(entry) + (i * width + j) * width + k;
  const auto along_z = [fz](const Rgb* q) { return q[0] + (q[1] - q[0]) * fz; };
  const Rgb c00 = along_z(corner), c01 = along_z(corner + width),
            c10 = along_z(corner + width * width), c11 = along_z(corner + width * width + width);
  const Rgb c0 = c00 + (c01 - c00) * fy, c1 = c10 + (c11 - c10) * fy;
  return c0 + (c1 - c0) * fx;
}

} // namespace vdbeam
