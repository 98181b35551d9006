#include "grids/refined_grid.h"

#include "machine/memory.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace vdbeam {
namespace {

/// Old lattice points that a new brick needs along an axis: half of its own number, plus the
/// support of the spline.
constexpr int block_width = brick_width / 2 + 4;

/// The spline at a lattice point, and halfway to the next.
constexpr std::array<float, 3> at_point{1.0f / 6, 4.0f / 6, 1.0f / 6};
constexpr std::array<float, 4> at_half{1.0f / 48, 23.0f / 48, 23.0f / 48, 1.0f / 48};

/// Filters along one axis: `source` has block_width points from that before the brick's first on,
/// with `stride` between them; returns new point i.
float filtered(const float* source, int stride, int i) {
  const float* first = source + stride * (i / 2);
  float sum = 0;
  if (i % 2 == 0)
    for (int k = 0; k < 3; ++k)
      sum += at_point[static_cast<std::size_t>(k)] * first[stride * k];
  else
    for (int k = 0; k < 4; ++k)
      sum += at_half[static_cast<std::size_t>(k)] * first[stride * k];
  return sum;
}

class Refiner {
public:
  Refiner(const DensityField& field, const FieldLimits& limits) : field_(field), limits_(limits) {
    // A spline reaches one lattice point farther than linear interpolation.
    counts_ = field.cell_counts() * 2 + Vec3<int>(2);
    bricks_.resize(static_cast<std::size_t>(counts_.x) * counts_.y);
  }

  DensityField refine(const std::string& label) {
    tbb::parallel_for(0, counts_.x * counts_.y, [&](int column) { fill_column(column); });
    std::size_t values = 0;
    for (const Column& column : bricks_)
      values += column.values.size();
    if (2 * values * sizeof(float) > limits_.bytes)
      throw FrameError(fmt::format("{}: with interpolation = \"cubic\" it needs {:.2f} GiB, more "
                                   "than the limit of {:.2f} GiB",
                                   label,
                                   static_cast<double>(2 * values * sizeof(float)) / (1 << 30),
                                   static_cast<double>(limits_.bytes) / (1 << 30)));
    std::vector<std::int32_t> table;
    std::vector<float> bricks;
    bricks.reserve(values);
    for (Column& column : bricks_) {
      for (const bool there : column.there) {
        table.push_back(there ? static_cast<std::int32_t>(next_brick_++)
                              : DensityField::empty_cell);
      }
      bricks.insert(bricks.end(), column.values.begin(), column.values.end());
      column = {};
    }
    const Vec3<std::int64_t> origin =
        field_.origin() * std::int64_t{2} - Vec3<std::int64_t>(cell_width);
    return DensityField(origin, counts_, std::move(table), std::move(bricks), {});
  }

private:
  struct Column {
    std::vector<bool> there;
    std::vector<float> values;
  };

  void fill_column(int index) {
    Column& column = bricks_[static_cast<std::size_t>(index)];
    std::array<float, block_width * block_width * block_width> block;
    std::array<float, DensityField::brick_size> brick;
    for (int k = 0; k < counts_.z; ++k) {
      const Vec3<int> cell{index / counts_.y, index % counts_.y, k};
      limits_.check();
      const bool there = gather(cell, block) && interpolate(block, brick);
      column.there.push_back(there);
      if (there)
        column.values.insert(column.values.end(), brick.begin(), brick.end());
    }
  }

  /// The old lattice's values about a new cell; false where all are 0.
  bool gather(const Vec3<int>& cell,
              std::array<float, block_width * block_width * block_width>& block) const {
    // The new lattice begins a cell, half an old one, before the old lattice.
    const Vec3<int> first = (cell - Vec3<int>(1)) * (cell_width / 2) - Vec3<int>(1);
    if (!near_anything(first))
      return false;
    bool any = false;
    std::size_t at = 0;
    for (int x = 0; x < block_width; ++x)
      for (int y = 0; y < block_width; ++y)
        for (int z = 0; z < block_width; ++z, ++at) {
          block[at] = field_.sample(Vec3f(first + Vec3<int>{x, y, z}));
          any = any || block[at] > 0;
        }
    return any;
  }
  /// Whether a cell of the old lattice in reach of the block holds anything.
  bool near_anything(const Vec3<int>& first) const {
    const Vec3<int>& n = field_.cell_counts();
    const auto cell_of = [](int point) { return point >= 0 ? point / cell_width : -1; };
    for (int i = cell_of(first.x - 1); i <= cell_of(first.x + block_width); ++i)
      for (int j = cell_of(first.y - 1); j <= cell_of(first.y + block_width); ++j)
        for (int k = cell_of(first.z - 1); k <= cell_of(first.z + block_width); ++k)
          if (i >= 0 && j >= 0 && k >= 0 && i < n.x && j < n.y && k < n.z &&
              field_.cell_maximum(field_.cell_offset(i, j, k)) > 0)
            return true;
    return false;
  }

  /// Filters along z, y and x; false where the brick is 0.
  static bool interpolate(const std::array<float, block_width * block_width * block_width>& block,
                          std::array<float, DensityField::brick_size>& brick) {
    constexpr int b = block_width, w = brick_width;
    std::array<float, b * b * w> by_z;
    std::array<float, b * w * w> by_y;
    for (int row = 0; row < b * b; ++row)
      for (int z = 0; z < w; ++z)
        by_z[static_cast<std::size_t>(row * w + z)] =
            filtered(&block[static_cast<std::size_t>(row * b)], 1, z);
    for (int x = 0; x < b; ++x)
      for (int y = 0; y < w; ++y)
        for (int z = 0; z < w; ++z)
          by_y[static_cast<std::size_t>((x * w + y) * w + z)] =
              filtered(&by_z[static_cast<std::size_t>(x * b * w + z)], w, y);
    bool any = false;
    for (int x = 0; x < w; ++x)
      for (int row = 0; row < w * w; ++row) {
        const float value = filtered(&by_y[static_cast<std::size_t>(row)], w * w, x);
        brick[static_cast<std::size_t>(x * w * w + row)] = value;
        any = any || value > 0;
      }
    return any;
  }

  const DensityField& field_;
  const FieldLimits& limits_;
  Vec3<int> counts_;
  std::vector<Column> bricks_;
  std::size_t next_brick_ = 0;
};

} // namespace

DensityGrid refined_grid(const DensityGrid& grid, const std::string& label,
                         const FieldLimits& limits) {
  DensityGrid result = grid;
  if (grid.field.empty())
    return result;
  Affine half;
  for (int a = 0; a < 3; ++a)
    half.rows[static_cast<std::size_t>(a)] = half.rows[static_cast<std::size_t>(a)] * 0.5;
  result.index_to_world = grid.index_to_world.after(half);
  result.active_voxels = 8 * grid.active_voxels;
  result.field = Refiner(grid.field, limits).refine(label);
  return_freed_memory();
  return result;
}

} // namespace vdbeam
