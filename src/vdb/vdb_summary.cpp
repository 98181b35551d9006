#include "machine/mapped_file.h"
#include "vdb/summary_codec.h"
#include "vdb/vdb_parse.h"

#include <openvdb/openvdb.h>

#include <cmath>
#include <limits>
#include <type_traits>

namespace vdbeam {

namespace {

/// Statistics of the active values of a float or double grid.
struct ValueStatistics {
  double minimum = std::numeric_limits<double>::infinity();
  double maximum = -std::numeric_limits<double>::infinity();
  double sum = 0;
  std::uint64_t count = 0;
  GridRepairs bad;

  void add(double value, std::uint64_t weight) {
    if (std::isnan(value)) {
      bad.nan += weight;
    } else if (std::isinf(value)) {
      bad.infinite += weight;
    } else {
      bad.negative += value < 0 ? weight : 0;
      minimum = std::min(minimum, value);
      maximum = std::max(maximum, value);
      sum += value * static_cast<double>(weight);
      count += weight;
    }
  }
  void store(GridSummary& summary) const {
    summary.bad_values = bad;
    summary.minimum = count > 0 ? minimum : 0;
    summary.maximum = count > 0 ? maximum : 0;
    summary.mean = count > 0 ? sum / static_cast<double>(count) : 0;
  }
};

/// Finds GridSummary::outline.
class Outline {
public:
  Outline(const openvdb::CoordBBox& box, double threshold)
      : box_(box), threshold_(threshold),
        columns_(2 * std::size_t{GridSummary::outline_steps} * GridSummary::outline_steps) {
    for (std::size_t i = 0; i < columns_.size(); i += 2)
      columns_[i] = GridSummary::outline_steps; // the last of an empty column is 0
  }

  void add(openvdb::CoordBBox part, double value) {
    part.intersect(box_);
    if (!(value > threshold_) || part.empty())
      return;
    int low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = cell(part.min()[axis], axis);
      // Up to where the next voxel begins: one voxel covers several cells of a small grid.
      high[axis] = std::max(low[axis], cell(part.max()[axis] + 1, axis) - 1);
    }
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        int* column = &columns_[2 * static_cast<std::size_t>(GridSummary::outline_steps * y + x)];
        column[0] = std::min(column[0], low[2]);
        column[1] = std::max(column[1], high[2]);
      }
  }
  std::vector<int> columns() && { return std::move(columns_); }

private:
  int cell(int index, int axis) const {
    const std::int64_t offset = std::int64_t{index} - box_.min()[axis];
    const std::int64_t size = std::int64_t{box_.max()[axis]} - box_.min()[axis] + 1;
    return static_cast<int>(offset * GridSummary::outline_steps / size);
  }

  openvdb::CoordBBox box_;
  double threshold_;
  std::vector<int> columns_;
};

template <class Grid>
std::vector<int> find_outline(const Grid& grid, const openvdb::CoordBBox& box, double threshold) {
  Outline outline(box, threshold);
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    for (auto value = leaf->cbeginValueOn(); value; ++value)
      outline.add({value.getCoord(), value.getCoord()}, value.getValue());
  auto tile = grid.tree().cbeginValueOn();
  tile.setMaxDepth(Grid::TreeType::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    openvdb::CoordBBox part;
    tile.getBoundingBox(part);
    outline.add(part, tile.getValue());
  }
  return std::move(outline).columns();
}

/// Counts by hand what OpenVDB's own functions would count through TBB.
template <class Grid>
void summarize_tree(const Grid& grid, GridSummary& summary) {
  using Tree = typename Grid::TreeType;
  constexpr bool is_scalar = std::is_floating_point_v<typename Grid::ValueType>;
  ValueStatistics statistics;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    ++summary.leaf_count;
    summary.active_voxels += leaf->onVoxelCount();
    if constexpr (is_scalar)
      for (auto value = leaf->cbeginValueOn(); value; ++value)
        statistics.add(value.getValue(), 1);
  }
  auto tile = grid.tree().cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    ++summary.tile_count;
    summary.active_voxels += tile.getVoxelCount();
    if constexpr (is_scalar)
      statistics.add(tile.getValue(), tile.getVoxelCount());
  }
  if constexpr (is_scalar) {
    if (grid.getGridClass() == openvdb::GRID_LEVEL_SET)
      statistics.bad.negative = 0; // the inside of a level set
    statistics.store(summary);
    summary.background = grid.background();
  }
}

Boxd box_in_world(const openvdb::math::Transform& transform, const openvdb::CoordBBox& box) {
  Boxd world;
  for (int corner = 0; corner < 8; ++corner) {
    const openvdb::Vec3d at = transform.indexToWorld(openvdb::Vec3d(
        corner & 1 ? box.max().x() : box.min().x(), corner & 2 ? box.max().y() : box.min().y(),
        corner & 4 ? box.max().z() : box.min().z()));
    world.extend({at.x(), at.y(), at.z()});
  }
  return world;
}

void summarize_map(const openvdb::math::Transform& transform, GridSummary& summary) {
  summary.map_type = transform.mapType();
  const openvdb::Vec3d size = transform.voxelSize();
  for (int axis = 0; axis < 3; ++axis)
    summary.voxel_size[axis] = size[axis];
  if (!transform.isLinear())
    return;
  const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  for (int i = 0; i < 3; ++i) {
    summary.index_to_world.rows[i] = {matrix(0, i), matrix(1, i), matrix(2, i)};
    summary.index_to_world.translation[i] = matrix(3, i);
  }
}

/// Summary of a grid from its metadata, without its tree.
GridSummary summarize_grid(const std::string& name, const openvdb::GridBase& grid) {
  GridSummary summary;
  summary.name = name;
  summary.saved_as_half = grid.saveFloatAsHalf();
  summary.value_type =
      summary.saved_as_half && grid.valueType() == "float" ? "half" : grid.valueType();
  summary.grid_class = openvdb::GridBase::gridClassToMenuName(grid.getGridClass());
  summary.index_lower = Vec3<std::int64_t>(0);
  summary.index_upper = Vec3<std::int64_t>(-1);
  summary.from_mantaflow =
      grid.getMetadata<openvdb::Vec3IMetadata>("file_base_resolution") != nullptr;
  summarize_map(grid.transform(), summary);
  return summary;
}

void set_bounds(const openvdb::GridBase& grid, const openvdb::CoordBBox& box,
                GridSummary& summary) {
  summary.index_lower = {box.min().x(), box.min().y(), box.min().z()};
  summary.index_upper = {box.max().x(), box.max().y(), box.max().z()};
  summary.world_bounds = box_in_world(grid.transform(), box);
}

/// Takes the voxel count and the bounds from the statistics that OpenVDB writes with a grid; false
/// where they are not there or cannot be right.
bool take_statistics(const openvdb::GridBase& grid, GridSummary& summary) {
  const auto count = grid.getMetadata<openvdb::Int64Metadata>(grid.META_FILE_VOXEL_COUNT);
  const auto lower = grid.getMetadata<openvdb::Vec3IMetadata>(grid.META_FILE_BBOX_MIN);
  const auto upper = grid.getMetadata<openvdb::Vec3IMetadata>(grid.META_FILE_BBOX_MAX);
  if (!count || !lower || !upper || count->value() < 0)
    return false;
  summary.active_voxels = static_cast<std::uint64_t>(count->value());
  if (summary.active_voxels == 0)
    return true;
  const openvdb::CoordBBox box{openvdb::Coord(lower->value()), openvdb::Coord(upper->value())};
  if (box.empty())
    return false;
  set_bounds(grid, box, summary);
  return true;
}

void write_encoded(const GridSummary& summary, int descriptor) {
  const std::vector<std::uint8_t> bytes = encode_summary(summary);
  write_all(descriptor, bytes.data(), bytes.size());
}

} // namespace

void write_header(const std::string& path, const std::string& wanted, int descriptor) {
  const std::string grid_name = require_density_grid(path, wanted);
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false);
  const openvdb::GridBase& grid =
      *make_immortal<openvdb::GridBase::Ptr>(file.readGridMetadata(grid_name));
  GridSummary summary = summarize_grid(grid_name, grid);
  if (take_statistics(grid, summary))
    write_encoded(summary, descriptor);
  else
    write_summary(path, grid_name, descriptor);
}

void write_summary(const std::string& path, const std::string& grid_name, int descriptor) {
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false);
  const openvdb::GridBase& grid = *make_immortal<openvdb::GridBase::Ptr>(file.readGrid(grid_name));
  GridSummary summary = summarize_grid(grid_name, grid);
  grid.apply<openvdb::GridTypes>([&summary](const auto& typed) {
    summarize_tree(typed, summary);
    openvdb::CoordBBox box;
    if (summary.active_voxels == 0 || !typed.tree().evalActiveVoxelBoundingBox(box))
      return;
    set_bounds(typed, box, summary);
    if constexpr (std::is_floating_point_v<typename std::decay_t<decltype(typed)>::ValueType>)
      if (typed.getGridClass() != openvdb::GRID_LEVEL_SET)
        summary.outline = find_outline(typed, box, summary.maximum / 100);
  });
  write_encoded(summary, descriptor);
}

} // namespace vdbeam
