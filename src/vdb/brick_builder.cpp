#include "vdb/brick_builder.h"

#include "vdb/leaf_values.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <unordered_map>

namespace vdbeam {

namespace {

constexpr std::int64_t maximum_cells = std::int64_t(1) << 28;
constexpr std::int32_t no_source = -1;
constexpr std::int32_t tile_base = -2; ///< source table: -2 - n is tile n

class Builder {
public:
  Builder(RawGrid& grid, std::string label, const FieldLimits& limits)
      : grid_(grid), label_(std::move(label)), limits_(limits) {}

  BrickedGrid build();

private:
  GridRepairs mend();
  bool find_bounds();
  void check_size(std::uint64_t cells, std::uint64_t bricks) const;
  void fill_sources();
  void fill_tile(std::int32_t number);
  void classify();
  void number_cells();
  void fill_bricks();
  void fill_brick(std::uint32_t offset, float* brick) const;
  std::int32_t classify_cell(int i, int j, int k) const;

  std::int32_t source(int i, int j, int k) const {
    return i < counts_.x && j < counts_.y && k < counts_.z ? sources_[offset(i, j, k)] : no_source;
  }
  std::size_t offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(i) * counts_.y + j) * counts_.z + k;
  }
  ValueRange range(std::int32_t source, int region) const {
    if (source >= 0)
      return ranges_[source][region];
    const float value = source == no_source ? 0 : grid_.tiles[tile_base - source].value;
    return {value, value};
  }
  Vec3<std::int64_t> leaf_cell(std::size_t leaf) const {
    const std::int32_t* origin = grid_.leaf_origins + 3 * leaf;
    return {origin[0] / leaf_width, origin[1] / leaf_width, origin[2] / leaf_width};
  }

  RawGrid& grid_;
  std::string label_;
  FieldLimits limits_;
  std::vector<LeafRanges> ranges_;
  Vec3<std::int64_t> lower_, upper_; ///< cell coordinates, upper_ exclusive
  Vec3<int> counts_;
  std::vector<std::int32_t> sources_; ///< per cell: a leaf, no_source, or tile_base - n
  std::vector<std::int32_t> cells_;
  std::vector<std::uint32_t> brick_cells_; ///< offset of each brick's cell, ascending
  std::vector<float> uniform_values_;
  std::vector<float> bricks_;
};

GridRepairs Builder::mend() {
  const Mender mender(grid_);
  ranges_.resize(grid_.leaf_count);
  GridRepairs repairs = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, grid_.leaf_count, 64), GridRepairs{},
      [&](const tbb::blocked_range<std::size_t>& leaves, GridRepairs found) {
        for (std::size_t leaf = leaves.begin(); leaf != leaves.end(); ++leaf) {
          float* values = grid_.leaf_values + leaf * leaf_size;
          mender.mend_leaf(values, found);
          ranges_[leaf] = measure_leaf(values);
        }
        return found;
      },
      [](GridRepairs a, const GridRepairs& b) {
        a.nan += b.nan;
        a.infinite += b.infinite;
        a.negative += b.negative;
        return a;
      });
  for (RawTile& tile : grid_.tiles) {
    const auto width = static_cast<std::uint64_t>(tile.width);
    tile.value = mender.mend(tile.value, repairs, width * width * width);
  }
  return repairs;
}

/// The cells that hold anything but 0; false where there are none.
bool Builder::find_bounds() {
  constexpr std::int64_t huge = std::int64_t(1) << 40;
  lower_ = Vec3<std::int64_t>(huge);
  upper_ = Vec3<std::int64_t>(-huge);
  const auto include = [this](const Vec3<std::int64_t>& cell, std::int64_t width,
                              const Vec3<std::int64_t>& apron) {
    lower_ = min(lower_, cell - apron);
    upper_ = max(upper_, cell + Vec3<std::int64_t>(width));
  };
  for (std::size_t leaf = 0; leaf < grid_.leaf_count; ++leaf)
    if (const LeafRanges& r = ranges_[leaf]; r[0].highest > 0)
      include(leaf_cell(leaf), 1, {r[4].highest > 0, r[2].highest > 0, r[1].highest > 0});
  for (const RawTile& tile : grid_.tiles)
    if (tile.value > 0)
      include(
          {tile.origin[0] / leaf_width, tile.origin[1] / leaf_width, tile.origin[2] / leaf_width},
          tile.width / leaf_width, Vec3<std::int64_t>(1));
  if (lower_.x >= upper_.x)
    return false;

  // Widths are below 2^30 each, so a product of two cannot overflow.
  const Vec3<std::int64_t> widths = upper_ - lower_;
  if (widths.x * widths.y > maximum_cells || widths.x * widths.y * widths.z > maximum_cells)
    throw FrameError(fmt::format(
        "{}: its voxels span {} x {} x {}, more than the 2^28 blocks of 8^3 that fit in the index "
        "table; crop the grid or split it in several volumes",
        label_, 8 * widths.x, 8 * widths.y, 8 * widths.z));
  check_size(static_cast<std::uint64_t>(widths.x * widths.y * widths.z), 0);
  counts_ = Vec3<int>(widths);
  return true;
}

void Builder::check_size(std::uint64_t cells, std::uint64_t bricks) const {
  const std::uint64_t bytes =
      bricks * sizeof(float) * DensityField::brick_size + cells * 3 * sizeof(std::int32_t);
  if (bytes > limits_.bytes)
    throw FrameError(fmt::format(
        "{}: needs {:.2f} GiB as bricks, more than the limit of {:.2f} GiB", label_,
        static_cast<double>(bytes) / (1 << 30), static_cast<double>(limits_.bytes) / (1 << 30)));
}

void Builder::fill_tile(std::int32_t number) {
  const RawTile& tile = grid_.tiles[number];
  const int width = tile.width / leaf_width;
  const Vec3<int> first(Vec3<std::int64_t>(tile.origin[0] / leaf_width, tile.origin[1] / leaf_width,
                                           tile.origin[2] / leaf_width) -
                        lower_);
  for (int i = first.x; i < first.x + width; ++i)
    for (int j = first.y; j < first.y + width; ++j)
      std::fill_n(sources_.begin() + static_cast<std::ptrdiff_t>(offset(i, j, first.z)), width,
                  tile_base - number);
}

void Builder::fill_sources() {
  sources_.assign(static_cast<std::size_t>(counts_.x) * counts_.y * counts_.z, no_source);
  for (std::size_t number = 0; number < grid_.tiles.size(); ++number)
    if (grid_.tiles[number].value > 0)
      fill_tile(static_cast<std::int32_t>(number));
  tbb::parallel_for(std::size_t(0), grid_.leaf_count, [this](std::size_t leaf) {
    if (ranges_[leaf][0].highest > 0) {
      const Vec3<int> cell(leaf_cell(leaf) - lower_);
      sources_[offset(cell.x, cell.y, cell.z)] = static_cast<std::int32_t>(leaf);
    }
  });
}

constexpr std::int32_t brick_mark = 0; ///< classified as a brick, not numbered yet

std::int32_t Builder::classify_cell(int i, int j, int k) const {
  ValueRange all = range(source(i, j, k), 0);
  for (int r = 1; r < 8; ++r)
    all.extend(range(source(i + (r >> 2), j + ((r >> 1) & 1), k + (r & 1)), r));
  if (all.highest == 0)
    return DensityField::empty_cell;
  return all.lowest == all.highest ? DensityField::uniform_base : brick_mark;
}

void Builder::classify() {
  cells_.resize(sources_.size());
  const int rows = counts_.x * counts_.y;
  tbb::parallel_for(0, rows, [this](int row) {
    const int i = row / counts_.y, j = row % counts_.y;
    for (int k = 0; k < counts_.z; ++k)
      cells_[offset(i, j, k)] = classify_cell(i, j, k);
  });
}

void Builder::number_cells() {
  std::unordered_map<float, std::int32_t> numbers;
  float last_value = -1;
  std::int32_t last_number = 0;
  for (std::size_t cell = 0; cell < cells_.size(); ++cell) {
    std::int32_t& entry = cells_[cell];
    if (entry == brick_mark) {
      entry = static_cast<std::int32_t>(brick_cells_.size());
      brick_cells_.push_back(static_cast<std::uint32_t>(cell));
    } else if (entry != DensityField::empty_cell) {
      const float value = range(sources_[cell], 0).highest;
      if (value != last_value) {
        last_value = value;
        const auto next = static_cast<std::int32_t>(uniform_values_.size());
        const auto [found, is_new] = numbers.try_emplace(value, next);
        if (is_new)
          uniform_values_.push_back(value);
        last_number = found->second;
      }
      entry = DensityField::uniform_base - last_number;
    }
  }
}

void Builder::fill_brick(std::uint32_t cell, float* brick) const {
  const int k = static_cast<int>(cell % static_cast<std::uint32_t>(counts_.z));
  const int row = static_cast<int>(cell / static_cast<std::uint32_t>(counts_.z));
  const int i = row / counts_.y, j = row % counts_.y;
  for (int r = 0; r < 8; ++r) {
    const Vec3<int> side{r >> 2, (r >> 1) & 1, r & 1};
    const std::int32_t from = source(i + side.x, j + side.y, k + side.z);
    const Vec3<int> first = side * leaf_width;
    const Vec3<int> size{side.x ? 1 : leaf_width, side.y ? 1 : leaf_width, side.z ? 1 : leaf_width};
    const float tile_value = range(from, r).lowest;
    for (int x = 0; x < size.x; ++x)
      for (int y = 0; y < size.y; ++y) {
        float* out = brick + ((first.x + x) * brick_width + first.y + y) * brick_width + first.z;
        if (from < 0)
          std::fill_n(out, size.z, tile_value);
        else
          std::copy_n(grid_.leaf_values + static_cast<std::size_t>(from) * leaf_size +
                          (x * leaf_width + y) * leaf_width,
                      size.z, out);
      }
  }
}

/// Bricks are made in batches, in the leaves' order, so that leaves can go while bricks come.
void Builder::fill_bricks() {
  constexpr std::size_t batch = 4096;
  bricks_.reserve(brick_cells_.size() * DensityField::brick_size);
  const auto slab = static_cast<std::size_t>(counts_.y) * counts_.z;
  std::size_t released = 0;
  for (std::size_t begin = 0; begin < brick_cells_.size(); begin += batch) {
    const std::size_t end = std::min(begin + batch, brick_cells_.size());
    limits_.check();
    bricks_.resize(end * DensityField::brick_size);
    tbb::parallel_for(begin, end, [this](std::size_t brick) {
      fill_brick(brick_cells_[brick], bricks_.data() + brick * DensityField::brick_size);
    });
    const std::int64_t done = lower_.x + static_cast<std::int64_t>(brick_cells_[end - 1] / slab);
    while (released < grid_.leaf_count && leaf_cell(released).x < done)
      ++released;
    grid_.release(released);
  }
}

BrickedGrid Builder::build() {
  BrickedGrid result;
  result.repairs = mend();
  if (!find_bounds())
    return result;
  limits_.check();
  fill_sources();
  classify();
  number_cells();
  check_size(cells_.size(), brick_cells_.size());
  fill_bricks();
  result.field = DensityField(lower_ * std::int64_t(8), counts_, std::move(cells_),
                              std::move(bricks_), std::move(uniform_values_));
  return result;
}

} // namespace

BrickedGrid build_bricks(RawGrid& grid, const std::string& label, const FieldLimits& limits) {
  return Builder(grid, label, limits).build();
}

} // namespace vdbeam
