#include "vdb/vector_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

bool is_missing(const Vec3f& v) {
  return std::isnan(v.x);
}

constexpr std::size_t cell_size = std::size_t{cell_width} * cell_width * cell_width;

std::size_t cell_offset(const Vec3<int>& n, const Vec3<int>& cell) {
  return (static_cast<std::size_t>(cell.x) * n.y + cell.y) * n.z + cell.z;
}
Vec3<int> cell_at(const Vec3<int>& n, std::size_t offset) {
  return {static_cast<int>(offset / n.z / n.y), static_cast<int>(offset / n.z % n.y),
          static_cast<int>(offset % n.z)};
}

/// Ring by ring, a cell without a vector takes the mean of its neighbours that have one.
void fill_cells_without(VectorField::Values& values) {
  const Vec3<int>& n = values.cells;
  std::vector<std::size_t> ring, next;
  const auto visit_neighbours = [&](std::size_t offset, const auto& visit) {
    const Vec3<int> cell = cell_at(n, offset);
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Vec3<int> other = cell;
        other[axis] += step;
        if (other[axis] >= 0 && other[axis] < n[axis])
          visit(cell_offset(n, other));
      }
  };
  for (std::size_t cell = 0; cell < values.means.size(); ++cell)
    if (!is_missing(values.means[cell]))
      ring.push_back(cell);
  if (ring.empty())
    values.means.assign(values.means.size(), Vec3f(0));
  std::vector<std::uint8_t> queued(values.means.size());
  while (!ring.empty()) {
    next.clear();
    for (const std::size_t cell : ring)
      visit_neighbours(cell, [&](std::size_t neighbour) {
        if (!queued[neighbour] && is_missing(values.means[neighbour])) {
          queued[neighbour] = 1;
          next.push_back(neighbour);
        }
      });
    std::vector<Vec3f> found;
    for (const std::size_t cell : next) {
      Vec3f sum;
      float count = 0;
      visit_neighbours(cell, [&](std::size_t neighbour) {
        if (!is_missing(values.means[neighbour])) {
          sum += values.means[neighbour];
          ++count;
        }
      });
      found.push_back(sum / count);
    }
    for (std::size_t i = 0; i < next.size(); ++i)
      values.means[next[i]] = found[i];
    std::swap(ring, next);
  }
}

/// The value of a voxel, or what stands for it; beyond the cells that of the nearest.
const Vec3f& voxel_value(const VectorField::Values& values, Vec3<int> p) {
  for (int a = 0; a < 3; ++a)
    p[a] = std::clamp(p[a], 0, cell_width * values.cells[a] - 1);
  const std::size_t cell =
      cell_offset(values.cells, {p.x / cell_width, p.y / cell_width, p.z / cell_width});
  if (const std::int32_t brick = values.table[cell]; brick >= 0) {
    const int voxel =
        ((p.x % cell_width) * cell_width + p.y % cell_width) * cell_width + p.z % cell_width;
    const Vec3f& value =
        values
            .bricks[static_cast<std::size_t>(brick) * cell_size + static_cast<std::size_t>(voxel)];
    if (!is_missing(value))
      return value;
  }
  return values.means[cell];
}

/// At a lattice point: of components on faces, the mean of the faces to both sides.
Vec3f lattice_value(const VectorField::Values& values, const Vec3<int>& p) {
  if (!values.staggered)
    return voxel_value(values, p);
  Vec3f result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<int> next = p;
    ++next[axis];
    result[axis] = 0.5f * (voxel_value(values, p)[axis] + voxel_value(values, next)[axis]);
  }
  return result;
}

} // namespace

VectorField::VectorField(Values values, double longest)
    : index_to_world_(values.index_to_world), from_mantaflow_(values.from_mantaflow),
      origin_(values.origin), cells_(values.cells) {
  find_means(values, longest);
  fill_cells_without(values);
  build_bricks(values);
  means_ = std::move(values.means);
  find_bounds();
}

/// Drops what is not to be trusted, and takes the mean of the rest of each cell.
void VectorField::find_means(Values& values, double longest) {
  const double longest_square = longest * longest;
  const auto trusted = [&](const Vec3f& v) {
    const double square = dot(Vec3d(v), Vec3d(v));
    return std::isfinite(square) && square <= longest_square;
  };
  values.means.resize(values.table.size(), Vec3f(not_a_number));
  for (std::size_t cell = 0; cell < values.table.size(); ++cell) {
    Vec3f& mean = values.means[cell];
    if (values.table[cell] < 0) {
      if (!is_missing(mean) && !trusted(mean)) {
        mean = Vec3f(not_a_number);
        outliers_ += cell_size;
      }
      continue;
    }
    Vec3f* brick = values.bricks.data() + static_cast<std::size_t>(values.table[cell]) * cell_size;
    Vec3d sum;
    std::size_t count = 0;
    for (std::size_t i = 0; i < cell_size; ++i) {
      // A voxel that is not active is NaN in all components, of three grids perhaps in some.
      const bool active =
          !(std::isnan(brick[i].x) && std::isnan(brick[i].y) && std::isnan(brick[i].z));
      if (active && trusted(brick[i])) {
        sum += Vec3d(brick[i]);
        ++count;
        continue;
      }
      outliers_ += active;
      brick[i] = Vec3f(not_a_number);
    }
    mean = count > 0 ? Vec3f(sum / static_cast<double>(count)) : Vec3f(not_a_number);
  }
}

/// Bricks of the cells in which, or at whose upper sides, there are vectors.
void VectorField::build_bricks(const Values& values) {
  const Vec3<int>& n = cells_;
  table_.assign(values.table.size(), -1);
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < table_.size(); ++cell) {
    const Vec3<int> c = cell_at(n, cell);
    bool any = false;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3<int> next{c.x + (corner & 1), c.y + (corner >> 1 & 1), c.z + (corner >> 2)};
      if (next.x < n.x && next.y < n.y && next.z < n.z)
        any = any || values.table[cell_offset(n, next)] >= 0;
    }
    if (any)
      table_[cell] = static_cast<std::int32_t>(count++);
  }
  constexpr std::size_t brick_size = std::size_t{brick_width} * brick_width * brick_width;
  bricks_.resize(count * brick_size);
  tbb::parallel_for(std::size_t{0}, table_.size(), [&](std::size_t cell) {
    if (table_[cell] < 0)
      return;
    const Vec3<int> c = cell_at(n, cell) * cell_width;
    Vec3f* out = bricks_.data() + static_cast<std::size_t>(table_[cell]) * brick_size;
    for (int i = 0; i < brick_width; ++i)
      for (int j = 0; j < brick_width; ++j)
        for (int k = 0; k < brick_width; ++k)
          *out++ = lattice_value(values, {c.x + i, c.y + j, c.z + k});
  });
}

void VectorField::find_bounds() {
  constexpr std::size_t brick_size = std::size_t{brick_width} * brick_width * brick_width;
  cell_bounds_.resize(table_.size());
  tbb::parallel_for(std::size_t{0}, table_.size(), [&](std::size_t cell) {
    cell_bounds_[cell].extend(means_[cell]);
    if (table_[cell] < 0)
      return;
    const Vec3f* brick = bricks_.data() + static_cast<std::size_t>(table_[cell]) * brick_size;
    Boxf bounds;
    for (std::size_t i = 0; i < brick_size; ++i)
      bounds.extend(brick[i]);
    cell_bounds_[cell] = bounds;
  });
}

Boxf VectorField::bounds(const Boxd& index) const {
  Vec3<int> first, last;
  for (int a = 0; a < 3; ++a) {
    const auto cell_at_index = [&](double x) { // beyond the cells those at the border
      const double cell = std::floor((x - static_cast<double>(origin_[a])) / cell_width);
      return static_cast<int>(std::clamp(cell, 0.0, static_cast<double>(cells_[a] - 1)));
    };
    first[a] = cell_at_index(index.lower[a]);
    last[a] = cell_at_index(index.upper[a]);
  }
  Boxf bounds;
  for (int i = first.x; i <= last.x; ++i)
    for (int j = first.y; j <= last.y; ++j)
      for (int k = first.z; k <= last.z; ++k)
        bounds.extend(cell_bounds_[cell_offset(cells_, {i, j, k})]);
  return bounds;
}

Vec3d VectorField::sample(const Vec3d& index) const {
  const Vec3d local = index - Vec3d(origin_);
  Vec3<int> cell, voxel;
  Vec3d f;
  for (int a = 0; a < 3; ++a) {
    // Beyond the cells the values at their border hold.
    const double x = std::clamp(local[a], 0.0, double{cell_width} * cells_[a]);
    const int below = std::min(static_cast<int>(x), cell_width * cells_[a] - 1);
    cell[a] = below / cell_width;
    voxel[a] = below % cell_width;
    f[a] = x - below;
  }
  const std::size_t offset = cell_offset(cells_, cell);
  if (table_[offset] < 0)
    return Vec3d(means_[offset]);
  const Vec3f* p =
      bricks_.data() +
      ((static_cast<std::size_t>(table_[offset]) * brick_width + voxel.x) * brick_width + voxel.y) *
          brick_width +
      voxel.z;
  const Vec3f share(f); // single precision is what the file has
  const auto along_z = [&](int at) { return p[at] + (p[at + 1] - p[at]) * share.z; };
  const auto along_y = [&](int at) {
    const Vec3f low = along_z(at);
    return low + (along_z(at + brick_width) - low) * share.y;
  };
  const Vec3f low = along_y(0);
  return Vec3d(low + (along_y(brick_width * brick_width) - low) * share.x);
}

} // namespace vdbeam
