#include "volume/density_field.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <stdexcept>

namespace vdbeam {

namespace {

/// Result of one pass over a cell's values: the largest, and the lattice points that are not 0.
struct CellExtent {
  float maximum = 0;
  Vec3<int> first{brick_width, brick_width, brick_width}, last{-1, -1, -1};

  void include(int axis, int position) {
    first[axis] = std::min(first[axis], position);
    last[axis] = std::max(last[axis], position);
  }
};

CellExtent measure_brick(const float* brick) {
  CellExtent extent;
  float along_z[brick_width] = {};
  for (int x = 0; x < brick_width; ++x) {
    float slice_maximum = 0;
    for (int y = 0; y < brick_width; ++y) {
      const float* row = brick + (x * brick_width + y) * brick_width;
      float row_maximum = 0;
      for (int z = 0; z < brick_width; ++z) {
        along_z[z] = std::max(along_z[z], row[z]);
        row_maximum = std::max(row_maximum, row[z]);
      }
      if (row_maximum > 0)
        extent.include(1, y);
      slice_maximum = std::max(slice_maximum, row_maximum);
    }
    if (slice_maximum > 0)
      extent.include(0, x);
    extent.maximum = std::max(extent.maximum, slice_maximum);
  }
  for (int z = 0; z < brick_width; ++z)
    if (along_z[z] > 0)
      extent.include(2, z);
  return extent;
}

/// Largest value and bounds of a range of cells; joins in any order to the same result.
struct Summary {
  float maximum = 0;
  Boxf occupied;

  void join(const Summary& other) {
    maximum = std::max(maximum, other.maximum);
    occupied.extend(other.occupied);
  }
  /// A lattice value lifts the field up to one voxel around it; beyond this cell the neighbouring
  /// cells, which hold the same lattice value, account for it.
  void add(const CellExtent& extent, const Vec3<int>& cell) {
    maximum = std::max(maximum, extent.maximum);
    Boxf box;
    for (int axis = 0; axis < 3; ++axis) {
      const int base = cell_width * cell[axis];
      box.lower[axis] = static_cast<float>(base + std::max(extent.first[axis] - 1, 0));
      box.upper[axis] = static_cast<float>(base + std::min(extent.last[axis] + 1, cell_width));
    }
    occupied.extend(box);
  }
};

} // namespace

DensityField::DensityField(Vec3<std::int64_t> origin, Vec3<int> cell_counts,
                           std::vector<std::int32_t> cells, std::vector<float> bricks,
                           std::vector<float> uniform_values)
    : origin_(origin), cell_counts_(cell_counts),
      limit_(Vec3f(cell_counts) * static_cast<float>(cell_width)), cells_(std::move(cells)),
      bricks_(std::move(bricks)), uniform_values_(std::move(uniform_values)) {
  const std::size_t count = static_cast<std::size_t>(cell_counts.x) * cell_counts.y * cell_counts.z;
  if (cells_.size() != count || bricks_.size() % brick_size != 0)
    throw std::invalid_argument("DensityField: the sizes of its parts do not fit together");
  std::vector<float> maxima(count);

  const auto measure = [&](const tbb::blocked_range<std::size_t>& range, Summary summary) {
    for (std::size_t offset = range.begin(); offset != range.end(); ++offset) {
      const std::int32_t entry = cells_[offset];
      if (entry == empty_cell)
        continue;
      CellExtent extent;
      if (entry >= 0)
        extent = measure_brick(brick(entry));
      else if (const float value = uniform_value(entry); value > 0)
        extent = {value, Vec3<int>(0), Vec3<int>(cell_width)};
      maxima[offset] = extent.maximum;
      if (extent.maximum > 0) {
        const std::size_t row = offset / cell_counts_.z;
        summary.add(extent,
                    {static_cast<int>(row / cell_counts_.y), static_cast<int>(row % cell_counts_.y),
                     static_cast<int>(offset % cell_counts_.z)});
      }
    }
    return summary;
  };
  const Summary summary = tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count, 256),
                                               Summary{}, measure, [](Summary a, const Summary& b) {
                                                 a.join(b);
                                                 return a;
                                               });
  maxima_ = SharedArray<float>(std::move(maxima));
  maximum_ = summary.maximum;
  occupied_ = summary.occupied;
  layers_ = DensityLayers::find(*this);
}

std::size_t DensityField::limit_values(float most) {
  if (maximum_ <= most)
    return 0;
  // Other fields may share the arrays.
  const auto limit = [most](SharedArray<float>& values) {
    std::vector<float> limited(values.data(), values.data() + values.size());
    std::size_t changed = 0;
    for (float& value : limited) {
      changed += value > most;
      value = std::min(value, most);
    }
    values = SharedArray<float>(std::move(limited));
    return changed;
  };
  limit(maxima_);
  maximum_ = most;
  const std::size_t changed = limit(bricks_) + limit(uniform_values_);
  layers_ = DensityLayers::find(*this);
  return changed;
}

std::size_t DensityField::bytes() const {
  return cells_.bytes() + bricks_.bytes() + uniform_values_.bytes() + maxima_.bytes();
}

} // namespace vdbeam
