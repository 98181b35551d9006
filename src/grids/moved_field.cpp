#include "grids/moved_field.h"

#include "grids/displacement.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace vdbeam {
namespace {

constexpr double most_cells = 1 << 28;

/// Where the values of a cell go; a box that is empty where it has none.
Boxd destination(const DensityField& field, const Displacement& motion, int i, int j, int k) {
  Boxd box;
  if (field.cell_maximum(field.cell_offset(i, j, k)) == 0)
    return box;
  const Vec3d corner = Vec3d(Vec3<int>{i, j, k}) * double{cell_width};
  // A point of the lattice gives weight to what lies up to a voxel before it.
  const Boxd cell{corner - Vec3d(1), corner + Vec3d(double{cell_width})};
  const Boxd way = motion.bounds(cell);
  return {cell.lower + way.lower, cell.upper + way.upper};
}

/// Cells of the moved field, from that of the local coordinates 8 * lower on.
struct CellRange {
  Vec3<std::int64_t> lower, upper; ///< of cells, upper excluded

  Vec3<int> counts() const { return Vec3<int>(upper - lower); }
};

CellRange cells_around(const Boxd& box) {
  CellRange range;
  for (int a = 0; a < 3; ++a) {
    range.lower[a] = static_cast<std::int64_t>(std::floor((box.lower[a] - 1) / cell_width));
    range.upper[a] = static_cast<std::int64_t>(std::floor((box.upper[a] + 1) / cell_width)) + 1;
  }
  return range;
}

template <class Visit>
void for_each_cell_in_parallel(const Vec3<int>& n, const Visit& visit) {
  tbb::parallel_for(0, n.x * n.y, [&](int column) {
    for (int k = 0; k < n.z; ++k)
      visit(column / n.y, column % n.y, k);
  });
}

/// The field is 0 at every point of a box (local coordinates): so are all lattice points in it and
/// around.
bool is_zero_in(const DensityField& field, const Boxd& box) {
  Vec3<int> first, last; // lattice points
  for (int a = 0; a < 3; ++a) {
    const double end = cell_width * field.cell_counts()[a] - 1;
    first[a] = static_cast<int>(std::clamp(std::floor(box.lower[a]), 0.0, end));
    last[a] = static_cast<int>(std::clamp(std::ceil(box.upper[a]), 0.0, end));
  }
  for (int i = first.x / cell_width; i <= last.x / cell_width; ++i)
    for (int j = first.y / cell_width; j <= last.y / cell_width; ++j)
      for (int k = first.z / cell_width; k <= last.z / cell_width; ++k) {
        const std::int32_t entry = field.cell(i, j, k);
        if (entry == DensityField::empty_cell)
          continue;
        if (entry < 0)
          return false;
        const Vec3<int> corner = Vec3<int>{i, j, k} * cell_width,
                        lower = max(first - corner, Vec3<int>(0)),
                        upper = min(last - corner, Vec3<int>(cell_width - 1));
        for (int x = lower.x; x <= upper.x; ++x)
          for (int y = lower.y; y <= upper.y; ++y) {
            const float* row = field.brick(entry) + (x * brick_width + y) * brick_width;
            if (std::any_of(row + lower.z, row + upper.z + 1, [](float v) { return v != 0; }))
              return false;
          }
      }
  return true;
}

class FieldMover {
public:
  FieldMover(const DensityField& field, const Displacement& motion)
      : field_(field), motion_(motion), stride_(motion.stride()) {}

  DensityField move(const std::string& label, const FieldLimits& limits) {
    find_targets(label);
    drop_targets_of_nothing();
    number_bricks();
    if (bricks_ * DensityField::brick_size * sizeof(float) > limits.bytes)
      throw FrameError(label + ": moved by its velocity it needs more memory than there may be");
    std::vector<float> values(bricks_ * DensityField::brick_size);
    for_each_cell_in_parallel(range_.counts(), [&](int i, int j, int k) {
      const std::int32_t brick = table_[offset(i, j, k)];
      if (brick < 0)
        return;
      limits.check();
      fill_brick(i, j, k,
                 values.data() + static_cast<std::size_t>(brick) * DensityField::brick_size);
    });
    drop_empty_bricks(values);
    if (values.empty())
      return {};
    return DensityField(field_.origin() + range_.lower * std::int64_t{cell_width}, range_.counts(),
                        std::move(table_), std::move(values), {});
  }

private:
  using Ways = std::array<Vec3d, DensityField::brick_size>;

  std::size_t offset(int i, int j, int k) const {
    const Vec3<int> n = range_.counts();
    return (static_cast<std::size_t>(i) * n.y + j) * n.z + k;
  }

  Vec3d corner_of(int i, int j, int k) const {
    return Vec3d(range_.lower + Vec3<std::int64_t>(Vec3<int>{i, j, k})) * double{cell_width};
  }

  /// Marks the cells that something comes to.
  void find_targets(const std::string& label) {
    const Vec3<int>& n = field_.cell_counts();
    std::vector<Boxd> boxes(static_cast<std::size_t>(n.x) * n.y * n.z);
    for_each_cell_in_parallel(n, [&](int i, int j, int k) {
      boxes[field_.cell_offset(i, j, k)] = destination(field_, motion_, i, j, k);
    });
    Boxd all;
    for (const Boxd& box : boxes)
      if (!box.empty())
        all.extend(box);
    range_ = cells_around(all);
    double cells = 1;
    for (int a = 0; a < 3; ++a)
      cells *= static_cast<double>(range_.upper[a] - range_.lower[a]);
    if (!(cells < most_cells))
      throw FrameError(label + ": its velocity carries it too far apart");
    table_.assign(static_cast<std::size_t>(cells), DensityField::empty_cell);
    for (const Boxd& box : boxes) {
      if (box.empty())
        continue;
      const CellRange target = cells_around(box);
      for (std::int64_t i = target.lower.x; i < target.upper.x; ++i)
        for (std::int64_t j = target.lower.y; j < target.upper.y; ++j)
          for (std::int64_t k = target.lower.z; k < target.upper.z; ++k)
            table_[offset(static_cast<int>(i - range_.lower.x),
                          static_cast<int>(j - range_.lower.y),
                          static_cast<int>(k - range_.lower.z))] = 0;
    }
  }
  /// Cells were marked generously: most unneeded ones are dropped before they are filled.
  void drop_targets_of_nothing() {
    constexpr double far = 1e15, slack = 2 * Displacement::near_enough;
    const Boxd anywhere = motion_.bounds({Vec3d(-far), Vec3d(far)});
    for_each_cell_in_parallel(range_.counts(), [&](int i, int j, int k) {
      std::int32_t& cell = table_[offset(i, j, k)];
      if (cell == DensityField::empty_cell)
        return;
      const Vec3d corner = corner_of(i, j, k);
      const Boxd points{corner, corner + Vec3d(double{cell_width})};
      // What comes to them lies among `sources`, so its velocities are the ones there.
      Boxd sources{points.lower - anywhere.upper, points.upper - anywhere.lower};
      for (int step = 0; step < 3; ++step) {
        const Boxd way = motion_.bounds(sources);
        sources = {points.lower - way.upper - Vec3d(slack),
                   points.upper - way.lower + Vec3d(slack)};
      }
      if (is_zero_in(field_, sources))
        cell = DensityField::empty_cell;
    });
  }
  void number_bricks() {
    for (std::int32_t& cell : table_)
      if (cell != DensityField::empty_cell)
        cell = static_cast<std::int32_t>(bricks_++);
  }
  /// The lattice points of a brick, those that it shares with its neighbours too.
  void fill_brick(int i, int j, int k, float* values) const {
    const Vec3d corner = corner_of(i, j, k);
    const Ways ways = ways_to(corner);
    for (int x = 0, at = 0; x < brick_width; ++x)
      for (int y = 0; y < brick_width; ++y)
        for (int z = 0; z < brick_width; ++z, ++at)
          values[at] = field_.sample(Vec3f(corner + Vec3d(Vec3<int>{x, y, z}) - ways[at]));
  }

  /// By how much what comes to the lattice points of a brick moves: found where the velocity's
  /// lattice has points, linear in between.
  Ways ways_to(const Vec3d& corner) const {
    Ways ways;
    Vec3d way; // neighbours come from near each other
    for (int x = 0; x < brick_width; x += stride_)
      for (int y = 0; y < brick_width; y += stride_)
        for (int z = 0; z < brick_width; z += stride_) {
          motion_.source_of(corner + Vec3d(Vec3<int>{x, y, z}), way);
          ways[(x * brick_width + y) * brick_width + z] = way;
        }
    for (int axis = 2; axis >= 0 && stride_ > 1; --axis)
      interpolate_along(axis, ways);
    return ways;
  }

  /// Fills what lies between points along an axis; along those before it only every stride-th is
  /// known, along those after it all are.
  void interpolate_along(int axis, Ways& ways) const {
    constexpr int steps[3] = {brick_width * brick_width, brick_width, 1};
    const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
    const int first_stride = axis > first ? stride_ : 1,
              second_stride = axis > second ? stride_ : 1;
    for (int u = 0; u < brick_width; u += first_stride)
      for (int v = 0; v < brick_width; v += second_stride)
        for (int w = 0; w < cell_width; w += stride_) {
          Vec3d* known = &ways[u * steps[first] + v * steps[second] + w * steps[axis]];
          const Vec3d difference = known[stride_ * steps[axis]] - *known;
          for (int i = 1; i < stride_; ++i)
            known[i * steps[axis]] = *known + difference * (static_cast<double>(i) / stride_);
        }
  }

  /// Rays need not look into cells that nothing came to.
  void drop_empty_bricks(std::vector<float>& values) {
    constexpr auto size = static_cast<std::ptrdiff_t>(DensityField::brick_size);
    std::int32_t kept = 0;
    for (std::int32_t& cell : table_) { // bricks are numbered in the order of the cells
      if (cell == DensityField::empty_cell)
        continue;
      const auto brick = values.begin() + cell * size;
      if (std::all_of(brick, brick + size, [](float value) { return value == 0; })) {
        cell = DensityField::empty_cell;
        continue;
      }
      if (kept != cell)
        std::copy(brick, brick + size, values.begin() + kept * size);
      cell = kept++;
    }
    values.resize(static_cast<std::size_t>(kept * size));
    values.shrink_to_fit();
  }

  const DensityField& field_;
  const Displacement& motion_;
  int stride_; ///< of the points at which ways are found
  CellRange range_;
  std::vector<std::int32_t> table_;
  std::size_t bricks_ = 0;
};

/// Nothing moves.
bool stands_still(const Motion& motion) {
  return motion.velocity.empty() || motion.settings.time * motion.settings.scale == 0;
}

} // namespace

DensityGrid moved_grid(const DensityGrid& grid, const Motion& motion, const std::string& label,
                       const FieldLimits& limits) {
  DensityGrid moved;
  moved.index_to_world = grid.index_to_world;
  moved.repairs = grid.repairs;
  moved.active_voxels = grid.active_voxels;
  moved.notes = grid.notes;
  moved.field = grid.field;
  if (grid.field.empty() || stands_still(motion))
    return moved;
  const Displacement displacement(grid, motion);
  moved.field = FieldMover(grid.field, displacement).move(label, limits);
  return moved;
}

Boxd ways_of(const Motion& motion) {
  if (stands_still(motion))
    return {Vec3d(0), Vec3d(0)};
  constexpr double far = 1e15;
  const Boxf velocities = motion.velocity.bounds({Vec3d(-far), Vec3d(far)});
  const VelocityScale meaning = scale_of(motion.settings, motion.velocity.from_mantaflow());
  Affine turn;
  if (meaning.index)
    turn.rows = motion.velocity.index_to_world().rows;
  const Boxd box = turn.bounds({Vec3d(velocities.lower), Vec3d(velocities.upper)});
  const double time = motion.settings.time * meaning.factor;
  return {min(box.lower * time, box.upper * time), max(box.lower * time, box.upper * time)};
}

std::function<Vec3d(const Vec3d& index)> sources_of(const DensityGrid& grid, const Motion& motion) {
  if (stands_still(motion))
    return [](const Vec3d& index) { return index; };
  const Vec3d origin(grid.field.origin());
  return [displacement = Displacement(grid, motion), origin](const Vec3d& index) {
    Vec3d way;
    return displacement.source_of(index - origin, way) + origin;
  };
}

} // namespace vdbeam
