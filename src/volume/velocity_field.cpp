#include "volume/velocity_field.h"

#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr int width = VelocityField::cell_width;
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

bool is_missing(const Vec3f& v) {
  return std::isnan(v.x);
}

} // namespace

VelocityScale scale_of(const VelocitySettings& settings, bool from_mantaflow) {
  // Blender runs Mantaflow with a step of 0.1 units for a frame of 1/25 s (at a time scale of 1).
  constexpr double mantaflow_units = 2.5;
  if (settings.units == VelocityUnits::automatic && from_mantaflow)
    return {true, mantaflow_units * settings.scale};
  return {settings.units == VelocityUnits::index, settings.scale};
}

VelocityField::VelocityField(Values values, double longest) : values_(std::move(values)) {
  find_means(longest);
  fill_cells_without();
}

/// Drops what is not to be trusted, and takes the mean of the rest of each cell.
void VelocityField::find_means(double longest) {
  const double longest_square = longest * longest;
  const auto trusted = [&](const Vec3f& v) {
    const double square = dot(Vec3d(v), Vec3d(v));
    return std::isfinite(square) && square <= longest_square;
  };
  values_.means.resize(values_.table.size(), Vec3f(not_a_number));
  for (std::size_t cell = 0; cell < values_.table.size(); ++cell) {
    Vec3f& mean = values_.means[cell];
    if (values_.table[cell] < 0) {
      if (!is_missing(mean) && !trusted(mean)) {
        mean = Vec3f(not_a_number);
        outliers_ += width * width * width;
      }
      continue;
    }
    constexpr std::size_t size = width * width * width;
    Vec3f* brick = values_.bricks.data() + static_cast<std::size_t>(values_.table[cell]) * size;
    Vec3d sum;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i) {
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

/// Ring by ring, a cell without a velocity takes the mean of its neighbours that have one.
void VelocityField::fill_cells_without() {
  const Vec3<int>& n = values_.cells;
  std::vector<std::size_t> ring, next;
  const auto visit_neighbours = [&](std::size_t cell, const auto& visit) {
    const int k = static_cast<int>(cell % n.z), j = static_cast<int>(cell / n.z % n.y),
              i = static_cast<int>(cell / n.z / n.y);
    const int at[3] = {i, j, k};
    const std::size_t strides[3] = {static_cast<std::size_t>(n.y) * n.z,
                                    static_cast<std::size_t>(n.z), 1};
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] > 0)
        visit(cell - strides[axis]);
      if (at[axis] + 1 < n[axis])
        visit(cell + strides[axis]);
    }
  };
  for (std::size_t cell = 0; cell < values_.means.size(); ++cell)
    if (!is_missing(values_.means[cell]))
      ring.push_back(cell);
  if (ring.empty())
    values_.means.assign(values_.means.size(), Vec3f(0));
  std::vector<std::uint8_t> queued(values_.means.size());
  while (!ring.empty()) {
    next.clear();
    for (const std::size_t cell : ring)
      visit_neighbours(cell, [&](std::size_t neighbour) {
        if (!queued[neighbour] && is_missing(values_.means[neighbour])) {
          queued[neighbour] = 1;
          next.push_back(neighbour);
        }
      });
    std::vector<Vec3f> found;
    for (const std::size_t cell : next) {
      Vec3f sum;
      float count = 0;
      visit_neighbours(cell, [&](std::size_t neighbour) {
        if (!is_missing(values_.means[neighbour])) {
          sum += values_.means[neighbour];
          ++count;
        }
      });
      found.push_back(sum / count);
    }
    for (std::size_t i = 0; i < next.size(); ++i)
      values_.means[next[i]] = found[i];
    std::swap(ring, next);
  }
}

const Vec3f& VelocityField::at(std::int64_t i, std::int64_t j, std::int64_t k) const {
  const auto cell_of = [](std::int64_t x, int cells) {
    return static_cast<int>(std::clamp<std::int64_t>(x >> 3, 0, cells - 1));
  };
  const std::size_t cell = cell_offset(cell_of(i, values_.cells.x), cell_of(j, values_.cells.y),
                                       cell_of(k, values_.cells.z));
  const bool inside = i >= 0 && j >= 0 && k >= 0 && i < std::int64_t{width} * values_.cells.x &&
                      j < std::int64_t{width} * values_.cells.y &&
                      k < std::int64_t{width} * values_.cells.z;
  if (const std::int32_t brick = values_.table[cell]; brick >= 0 && inside) {
    const auto voxel = static_cast<std::size_t>(((i & 7) * width + (j & 7)) * width + (k & 7));
    const Vec3f& value =
        values_.bricks[static_cast<std::size_t>(brick) * width * width * width + voxel];
    if (!is_missing(value))
      return value;
  }
  return values_.means[cell];
}

Vec3d VelocityField::trilinear(const Vec3d& local) const {
  const Vec3d base{std::floor(local.x), std::floor(local.y), std::floor(local.z)};
  const Vec3d f = local - base;
  const auto i = static_cast<std::int64_t>(base.x), j = static_cast<std::int64_t>(base.y),
             k = static_cast<std::int64_t>(base.z);
  Vec3d sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const double weight = (a ? f.x : 1 - f.x) * (b ? f.y : 1 - f.y) * (c ? f.z : 1 - f.z);
    if (weight > 0)
      sum += Vec3d(at(i + a, j + b, k + c)) * weight;
  }
  return sum;
}

Vec3d VelocityField::sample(const Vec3d& index) const {
  constexpr double farthest = 1e9; // beyond it integers would overflow
  const Vec3d local = max(Vec3d(-farthest), min(Vec3d(farthest), index - Vec3d(values_.origin)));
  if (!values_.staggered)
    return trilinear(local);
  Vec3d result;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3d face = local;
    face[axis] += 0.5;
    result[axis] = trilinear(face)[axis];
  }
  return result;
}

} // namespace vdbeam
