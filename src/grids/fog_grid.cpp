#include "grids/fog_grid.h"

#include "vdbeam/error.h"
#include "volume/fog_shape.h"

#include <tbb/parallel_for.h>

namespace vdbeam {
namespace {

/// Calls visit(cell, offset in the table) for all cells.
template <class Visit>
void for_each_cell(const Vec3<int>& cells, const Visit& visit) {
  std::size_t offset = 0;
  Vec3<int> cell;
  for (cell.x = 0; cell.x < cells.x; ++cell.x)
    for (cell.y = 0; cell.y < cells.y; ++cell.y)
      for (cell.z = 0; cell.z < cells.z; ++cell.z)
        visit(cell, offset++);
}

std::uint64_t voxels_of(const Vec3<int>& cells) {
  const Vec3<std::uint64_t> n(cells * cell_width);
  return n.x * n.y * n.z;
}

/// The table of a shape, with bricks for its mixed cells; `of_bricks`: a cell for each of them.
std::vector<std::int32_t> number_cells(const FogShape& shape, std::vector<Vec3<int>>& of_bricks) {
  std::vector<std::int32_t> table(static_cast<std::size_t>(shape.cells().x) * shape.cells().y *
                                  shape.cells().z);
  if (shape.is_layered())
    for (int y = 0; y < shape.cells().y; ++y)
      of_bricks.push_back({0, y, 0});
  for_each_cell(shape.cells(), [&](const Vec3<int>& cell, std::size_t offset) {
    const FogShape::Cell kind = shape.cell(cell);
    std::int32_t& entry = table[offset];
    if (kind == FogShape::Cell::empty)
      entry = DensityField::empty_cell;
    else if (kind == FogShape::Cell::full)
      entry = DensityField::uniform_base;
    else if (shape.is_layered())
      entry = cell.y;
    else {
      entry = static_cast<std::int32_t>(of_bricks.size());
      of_bricks.push_back(cell);
    }
  });
  return table;
}

} // namespace

DensityGrid fog_grid(const VolumeSettings& volume, const FieldLimits& limits) {
  const FogShape shape(volume);
  std::vector<Vec3<int>> of_bricks;
  std::vector<std::int32_t> table = number_cells(shape, of_bricks);
  if (of_bricks.size() * DensityField::brick_size * sizeof(float) > limits.bytes)
    throw FrameError("a volume without a file needs more memory than there may be: give it less "
                     "noise_octaves, or a greater noise_size");
  std::vector<float> bricks(of_bricks.size() * DensityField::brick_size);
  tbb::parallel_for(std::size_t{0}, of_bricks.size(), [&](std::size_t brick) {
    limits.check();
    float* out = bricks.data() + brick * DensityField::brick_size;
    const Vec3d corner = Vec3d(of_bricks[brick]) * double{cell_width};
    for (int x = 0; x < brick_width; ++x)
      for (int y = 0; y < brick_width; ++y)
        for (int z = 0; z < brick_width; ++z)
          *out++ = static_cast<float>(shape.value(corner + Vec3d(Vec3<int>{x, y, z})));
  });
  DensityGrid grid;
  grid.field = DensityField({}, shape.cells(), std::move(table), std::move(bricks), {1.0f});
  grid.index_to_world = shape.to_own();
  grid.active_voxels = voxels_of(shape.cells());
  if (shape.is_coarse())
    grid.notes.emplace_back("a volume without a file: its lattice is too coarse for the finest "
                            "features of its noise; give it less noise_octaves, a greater "
                            "noise_size or a smaller box");
  return grid;
}

GridSummary fog_header(const VolumeSettings& volume) {
  const FogShape shape(volume);
  GridSummary header;
  header.active_voxels = voxels_of(shape.cells());
  header.index_upper = Vec3<std::int64_t>(shape.cells() * cell_width - Vec3<int>(1));
  header.index_to_world = shape.to_own();
  return header;
}

GridShape fog_grid_shape(const VolumeSettings& volume) {
  const FogShape shape(volume);
  GridShape result;
  result.active_voxels = voxels_of(shape.cells());
  result.value_sum = shape.integral() / shape.to_own().determinant();
  for_each_cell(shape.cells(), [&](const Vec3<int>& cell, std::size_t) {
    if (shape.cell(cell) == FogShape::Cell::empty)
      return;
    ActiveBox box;
    for (int a = 0; a < 3; ++a) {
      box.lower[static_cast<std::size_t>(a)] = cell[a] * cell_width;
      box.upper[static_cast<std::size_t>(a)] = (cell[a] + 1) * cell_width - 1;
    }
    result.leaves.push_back(box);
  });
  result.leaf_count = result.leaves.size();
  return result;
}

std::uint64_t fog_bytes(const VolumeSettings& volume) {
  const FogShape shape(volume);
  std::vector<Vec3<int>> of_bricks;
  const std::size_t cells = number_cells(shape, of_bricks).size();
  return of_bricks.size() * DensityField::brick_size * sizeof(float) +
         cells * (sizeof(std::int32_t) + sizeof(float));
}

} // namespace vdbeam
