#include "vdb/grid_shape.h"

#include "vdb/guarded_read.h"
#include "vdb/vdb_shape.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace vdbeam {
namespace {

/// Marks of one set at most: a byte each. Larger tables are estimated at a coarser scale.
constexpr double most_marks = 1 << 26;

Vec3<std::int64_t> cell_of(const std::array<std::int32_t, 3>& voxel, std::int64_t scale,
                           std::int64_t reach, int width) {
  Vec3<std::int64_t> cell;
  for (int a = 0; a < 3; ++a) {
    const std::int64_t v = scale * voxel[static_cast<std::size_t>(a)] + reach;
    cell[a] = v >= 0 ? v / width : (v - width + 1) / width;
  }
  return cell;
}

} // namespace

GridShape read_grid_shape(const std::string& path, const std::string& grid_name,
                          const ReadLimits& limits) {
  const MappedFile file =
      read_guarded(path, limits, [&](int output) { write_shape(path, grid_name, output); });
  ShapeHeader header;
  if (file.size() < sizeof header)
    throw FrameError(path + ": the file is corrupt");
  std::memcpy(&header, file.data(), sizeof header);
  const std::uint64_t boxes = (file.size() - sizeof header) / sizeof(ActiveBox);
  if (header.leaf_count > boxes || header.tile_count != boxes - header.leaf_count)
    throw FrameError(path + ": the file is corrupt");
  GridShape shape;
  shape.active_voxels = header.active_voxels;
  shape.node_bytes = header.node_bytes;
  shape.value_bytes = header.value_bytes;
  shape.value_sum = header.value_sum;
  shape.leaf_count = header.tree_leaves;
  shape.leaves.resize(header.leaf_count);
  shape.tiles.resize(header.tile_count);
  const std::byte* first = file.data() + sizeof header;
  std::memcpy(static_cast<void*>(shape.leaves.data()), first,
              header.leaf_count * sizeof(ActiveBox));
  std::memcpy(static_cast<void*>(shape.tiles.data()), first + header.leaf_count * sizeof(ActiveBox),
              header.tile_count * sizeof(ActiveBox));
  return shape;
}

namespace {

/// The voxels of a box that are wanted.
ActiveBox clipped(ActiveBox box, const std::optional<WantedBox::Voxels>& wanted) {
  for (std::size_t a = 0; wanted && a < 3; ++a) {
    const auto limit = [&](std::int64_t v) {
      return std::clamp<std::int64_t>(v, std::int64_t{box.lower[a]} - 1,
                                      std::int64_t{box.upper[a]} + 1);
    };
    const std::int64_t lower = limit(wanted->lower[static_cast<int>(a)]),
                       upper = limit(wanted->upper[static_cast<int>(a)]);
    box.lower[a] = std::max(box.lower[a], static_cast<std::int32_t>(lower));
    box.upper[a] = std::min(box.upper[a], static_cast<std::int32_t>(upper));
  }
  return box;
}

bool is_empty(const ActiveBox& box) {
  return box.lower[0] > box.upper[0] || box.lower[1] > box.upper[1] || box.lower[2] > box.upper[2];
}

/// The cells of a box, by marks of `width` voxels.
struct BoxCells {
  BoxCells(const ActiveBox& box, int scale, int reach, int width)
      // A lattice point at the lower face of a cell is also one of the brick before it.
      : first(cell_of(box.lower, scale, -reach - 1, width)),
        last(cell_of(box.upper, scale, reach, width)) {}

  Vec3<std::int64_t> first, last;
};

} // namespace

CellSet::CellSet(const GridShape& shape, int scale, int reach,
                 const std::optional<WantedBox::Voxels>& wanted) {
  int width = cell_width; // of a mark, in voxels
  const auto for_each = [&](const auto& visit) {
    for (const auto* boxes : {&shape.leaves, &shape.tiles})
      for (const ActiveBox& whole : *boxes)
        if (const ActiveBox box = clipped(whole, wanted); !is_empty(box))
          visit(box, BoxCells(box, scale, reach, width), boxes == &shape.tiles);
  };
  Vec3<std::int64_t> lower, upper;
  for (;; width *= 2, width_ *= 2) {
    bool any = false;
    for_each([&](const ActiveBox&, const BoxCells& cells, bool) {
      lower = any ? min(lower, cells.first) : cells.first;
      upper = any ? max(upper, cells.last) : cells.last;
      any = true;
    });
    if (!any)
      return;
    const Vec3d size(upper - lower + Vec3<std::int64_t>(1));
    if (size.x * size.y * size.z <= most_marks)
      break;
  }
  lower_ = lower;
  counts_ = Vec3<int>(upper - lower) + Vec3<int>(1);
  marks_.assign(static_cast<std::size_t>(counts_.x) * static_cast<std::size_t>(counts_.y) *
                    static_cast<std::size_t>(counts_.z),
                0);
  if (scale == 1 && width_ == 1)
    blocks_.assign(marks_.size(), 0);
  for_each([&](const ActiveBox& box, const BoxCells& cells, bool tile) {
    if (!blocks_.empty() && !tile) {
      const Vec3<int> at(cell_of(box.lower, 1, 0, width) - lower);
      blocks_[offset(at.x, at.y, at.z)] = box.blocks;
    }
    mark(Vec3<int>(cells.first - lower), Vec3<int>(cells.last - lower), tile ? &box : nullptr);
  });
}

/// Marks the cells from a to b. What lies inside a tile is uniform, and no brick.
void CellSet::mark(const Vec3<int>& a, const Vec3<int>& b, const ActiveBox* tile) {
  for (int i = a.x; i <= b.x; ++i)
    for (int j = a.y; j <= b.y; ++j)
      for (int k = a.z; k <= b.z; ++k) {
        const bool inside = tile && i > a.x && j > a.y && k > a.z && i < b.x && j < b.y && k < b.z;
        if (!inside)
          marks_[offset(i, j, k)] = 1;
        if (tile && !blocks_.empty())
          blocks_[offset(i, j, k)] = tile->blocks;
      }
}

bool CellSet::holds(const Vec3d& cell) const {
  Vec3<int> at;
  for (int a = 0; a < 3; ++a) {
    const double mark = std::floor(cell[a] / width_) - static_cast<double>(lower_[a]);
    if (!(mark >= 0 && mark < counts_[a]))
      return false;
    at[a] = static_cast<int>(mark);
  }
  return marks_[offset(at.x, at.y, at.z)] != 0;
}

bool CellSet::may_hold(const Vec3d& cell) const {
  if (blocks_.empty())
    return holds(cell);
  for (int corner = 0; corner < 8; ++corner) { // voxels that a sample there is made from
    std::size_t block = 0;
    Vec3<int> at;
    for (int a = 0; a < 3; ++a) {
      const auto voxel = static_cast<std::int64_t>(std::floor(cell[a] * cell_width)) +
                         (corner >> a & 1) - lower_[a] * cell_width;
      if (voxel < 0 || voxel >= std::int64_t{counts_[a]} * cell_width)
        return holds(cell); // beside the table
      at[a] = static_cast<int>(voxel / cell_width);
      block = 4 * block + static_cast<std::size_t>(voxel % cell_width / 2);
    }
    if ((blocks_[offset(at.x, at.y, at.z)] >> block & 1) != 0)
      return true;
  }
  return false;
}

Boxd CellSet::bounds() const {
  const double width = width_;
  return {Vec3d(lower_) * width, Vec3d(lower_ + Vec3<std::int64_t>(counts_)) * width};
}

std::uint64_t CellSet::count() const {
  const auto marks = std::count(marks_.begin(), marks_.end(), std::uint8_t{1});
  return static_cast<std::uint64_t>(marks) * static_cast<std::uint64_t>(width_) *
         static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(width_);
}

Vec3d CellSet::columns() const {
  Vec3d sum;
  for (int axis = 0; axis < 3; ++axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    for (int i = 0; i < counts_[b]; ++i)
      for (int j = 0; j < counts_[c]; ++j) {
        bool any = false;
        Vec3<int> at;
        at[b] = i;
        at[c] = j;
        for (at[axis] = 0; at[axis] < counts_[axis] && !any; ++at[axis])
          any = marks_[offset(at.x, at.y, at.z)] != 0;
        sum[axis] += any ? double{1} * width_ * width_ : 0;
      }
  }
  return sum;
}

std::uint64_t CellSet::cells() const {
  return marks_.size() * static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(width_) *
         static_cast<std::uint64_t>(width_);
}

void CellSet::spread_along(int axis, int lower, int upper) {
  std::vector<std::uint8_t> from = marks_;
  const std::size_t stride =
      axis == 2   ? 1
      : axis == 1 ? static_cast<std::size_t>(counts_.z)
                  : static_cast<std::size_t>(counts_.y) * static_cast<std::size_t>(counts_.z);
  const int n = counts_[axis];
  for (std::size_t at = 0; at < from.size(); ++at) {
    if (from[at] == 0)
      continue;
    const int here = static_cast<int>(at / stride % static_cast<std::size_t>(n));
    for (int c = std::max(0, here + lower); c <= std::min(n - 1, here + upper); ++c)
      marks_[at + static_cast<std::size_t>(c) * stride - static_cast<std::size_t>(here) * stride] =
          1;
  }
}

CellSet CellSet::spread(const Vec3<int>& lower, const Vec3<int>& upper) const {
  CellSet set;
  if (empty())
    return set;
  Vec3<int> low, high;
  for (int a = 0; a < 3; ++a) { // by whole marks
    low[a] = -((-lower[a] + width_ - 1) / width_);
    high[a] = (upper[a] + width_ - 1) / width_;
  }
  set.width_ = width_;
  set.lower_ = lower_ + Vec3<std::int64_t>(low);
  set.counts_ = counts_ + high - low;
  const Vec3d size(set.counts_);
  if (size.x * size.y * size.z > 8 * most_marks)
    throw FrameError("a volume spans too many blocks of 8^3 voxels once it is displaced");
  set.marks_.assign(static_cast<std::size_t>(size.x * size.y * size.z), 0);
  for (int i = 0; i < counts_.x; ++i)
    for (int j = 0; j < counts_.y; ++j)
      for (int k = 0; k < counts_.z; ++k)
        if (marks_[offset(i, j, k)] != 0)
          set.marks_[set.offset(i - low.x, j - low.y, k - low.z)] = 1;
  for (int a = 0; a < 3; ++a)
    set.spread_along(a, low[a], high[a]);
  return set;
}

} // namespace vdbeam
