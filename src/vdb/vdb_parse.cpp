#include "vdb/vdb_parse.h"

#include "machine/mapped_file.h"
#include "vdb/density_kind.h"
#include "vdb/raw_grid.h"
#include "vdb/vdb_names.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

namespace vdbeam {

namespace {

std::vector<std::string> grid_names(openvdb::io::File& file) {
  std::vector<std::string> names;
  for (auto name = file.beginName(); name != file.endName(); ++name)
    names.push_back(name.gridName());
  return names;
}

/// OpenVDB also finds a grid by its name where several share it: then the first of them.
std::string find_grid(openvdb::io::File& file, const std::string& path, const std::string& wanted) {
  if (file.hasGrid(wanted))
    return wanted;
  const std::vector<std::string> names = grid_names(file);
  const std::string name = same_grid_name(wanted, names);
  if (name.empty())
    throw InputError(missing_grid_message(path, wanted, names));
  return name;
}

[[noreturn]] void refuse(const std::string& path, const std::string& grid, const std::string& why) {
  throw InputError(fmt::format("{}: grid \"{}\" {}", path, grid, why));
}

/// Refuses what is no density by its kind; `background` is that of the values, 0 where it does not
/// matter.
void check_kind(const std::string& path, const std::string& name, const openvdb::GridBase& grid,
                bool level_set, double background) {
  const openvdb::math::Transform& transform = grid.transform();
  const GridKind kind{grid.valueType(), transform.mapType(), transform.isLinear(), level_set,
                      background};
  if (const auto why = why_no_density(kind))
    refuse(path, name, *why);
}

/// Refuses unsuitable grids before their voxels are read.
void check_kind(const std::string& path, const std::string& name, const openvdb::GridBase& grid) {
  check_kind(path, name, grid, false, 0);
}

std::array<double, 12> affine_rows(const std::string& path, const std::string& name,
                                   const openvdb::math::Transform& transform) {
  const openvdb::math::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  std::array<double, 12> rows{};
  bool finite = true;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      rows[4 * i + j] = matrix(j, i); // OpenVDB multiplies row vectors from the left
      finite = finite && std::isfinite(rows[4 * i + j]);
    }
  if (!finite || !(std::abs(matrix.det()) > 0))
    refuse(path, name, "has a transform that is singular or not finite");
  return rows;
}

float to_float(float value) {
  return value;
}
float to_float(double value) {
  if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
    return std::copysign(std::numeric_limits<float>::infinity(), value < 0 ? -1.0f : 1.0f);
  return static_cast<float>(value);
}

/// Calls `visit(tile iterator)` for each tile that matters: not 0 nor the background, or in a level
/// set not outside.
template <class Tree, class Visit>
void for_each_tile(const Tree& tree, bool level_set, Visit visit) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    if (level_set ? !(tile.getValue() >= 0)
                  : tile.getValue() != 0 && tile.getValue() != tree.background())
      visit(tile);
}

template <class Tree>
std::vector<RawTile> collect_tiles(const Tree& tree, bool level_set) {
  std::size_t count = 0;
  for_each_tile(tree, level_set, [&count](const auto&) { ++count; });
  std::vector<RawTile> tiles;
  tiles.reserve(count); // a growing vector would need three times the memory
  for_each_tile(tree, level_set, [&tiles](const auto& tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    tiles.push_back({{box.min().x(), box.min().y(), box.min().z()},
                     static_cast<std::int32_t>(box.dim().x()),
                     to_float(tile.getValue())});
  });
  return tiles;
}

template <class Tree>
std::uint64_t active_tile_voxels(const Tree& tree) {
  std::uint64_t count = 0;
  auto tile = tree.cbeginValueOn();
  tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile)
    count += tile.getVoxelCount();
  return count;
}

void append_floats(std::vector<float>& to, const float* leaf) {
  to.insert(to.end(), leaf, leaf + leaf_size);
}
void append_floats(std::vector<float>& to, const double* leaf) {
  std::transform(leaf, leaf + leaf_size, std::back_inserter(to),
                 [](double value) { return to_float(value); });
}

/// Values equal to `background` become 0.
template <class Leaf>
void write_leaves(const std::vector<const Leaf*>& leaves, float background, int descriptor) {
  constexpr std::size_t batch = 64;
  std::vector<float> values;
  std::vector<std::int32_t> origins;
  origins.reserve(3 * leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    append_floats(values, leaves[i]->buffer().data());
    if (values.size() == batch * leaf_size || i + 1 == leaves.size()) {
      if (background != 0)
        std::replace(values.begin(), values.end(), background, 0.0f);
      write_all(descriptor, values.data(), values.size() * sizeof(float));
      values.clear();
    }
    for (int axis = 0; axis < 3; ++axis)
      origins.push_back(leaves[i]->origin()[axis]);
  }
  write_all(descriptor, origins.data(), origins.size() * sizeof(std::int32_t));
}

/// What is wanted of a grid, all else being background. OpenVDB reads the masks of its nodes, and
/// the values of leaves that lie in the box.
const openvdb::GridBase& read_part(openvdb::io::File& file, const std::string& path,
                                   const std::string& name, const openvdb::GridBase& metadata,
                                   const WantedBox& wanted) {
  const openvdb::math::Transform& transform = metadata.transform();
  const WantedBox::Voxels voxels =
      wanted.voxels(Affine::from_matrix(affine_rows(path, name, transform)));
  const auto corner = [](const Vec3<std::int64_t>& v) {
    return openvdb::Vec3d(static_cast<double>(v.x), static_cast<double>(v.y),
                          static_cast<double>(v.z));
  };
  const openvdb::BBoxd box =
      transform.indexToWorld(openvdb::BBoxd(corner(voxels.lower), corner(voxels.upper)));
  auto& grid = make_immortal<openvdb::GridBase::Ptr>(file.readGrid(name, box));
  const auto voxel = [](const Vec3<std::int64_t>& v) {
    return openvdb::Coord(static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z));
  };
  // The box of the world that holds those of a turned or sheared grid is larger.
  grid->clip({voxel(voxels.lower), voxel(voxels.upper)});
  return *grid;
}

/// One flipped bit turns a tile on that stands for millions of voxels. What programs change after
/// they have counted differs by far less, and is worth a note only.
void check_declared_voxels(const std::string& path, const std::string& name,
                           const RawGridHeader& header) {
  constexpr std::uint64_t most_times = 1000;
  if (header.declared_voxels < 0)
    return;
  const auto declared = static_cast<std::uint64_t>(header.declared_voxels);
  if (header.active_voxels / most_times > std::max<std::uint64_t>(declared, 1))
    throw FrameError(fmt::format("{}: grid \"{}\" has {} active voxels, but its file says {}; the "
                                 "file is damaged: copy or export it again",
                                 path, name, header.active_voxels, declared));
}

template <class Grid>
void write_grid(const std::string& path, const std::string& name, const Grid& grid,
                Background background, bool cropped, int descriptor) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  static_assert(Leaf::SIZE == leaf_size);
  RawGridHeader header;
  header.index_to_world = affine_rows(path, name, grid.transform());
  const bool level_set = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
  header.level_set = level_set;
  header.cropped = cropped;
  header.from_mantaflow = static_cast<bool>(grid["file_base_resolution"]);
  name.copy(header.name.data(), header.name.size() - 1);
  if (const auto declared = grid.template getMetadata<openvdb::Int64Metadata>(
          openvdb::GridBase::META_FILE_VOXEL_COUNT))
    header.declared_voxels = declared->value();
  if (level_set || background == Background::refused)
    check_kind(path, name, grid, level_set, static_cast<double>(grid.background()));

  std::vector<const Leaf*> leaves;
  header.active_voxels = active_tile_voxels(grid.tree());
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    leaves.push_back(leaf.getLeaf());
    header.active_voxels += leaf->onVoxelCount();
  }
  check_declared_voxels(path, name, header);
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
  const std::vector<RawTile> tiles = collect_tiles(grid.tree(), level_set);
  header.leaf_count = leaves.size();
  header.tile_count = tiles.size();

  std::array<char, RawGridHeader::values_offset> page{};
  std::memcpy(page.data(), &header, sizeof header);
  write_all(descriptor, page.data(), page.size());
  write_leaves(leaves, level_set ? 0 : to_float(grid.background()), descriptor);
  write_all(descriptor, tiles.data(), tiles.size() * sizeof(RawTile));
}

} // namespace

void prepare_openvdb() {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
}

void write_grid_names(const std::string& path, int descriptor) {
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false);
  for (const std::string& name : grid_names(file))
    write_all(descriptor, name.c_str(), name.size() + 1); // with the 0 that ends it
}

std::string require_density_grid(const std::string& path, const std::string& grid_name) {
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false);
  const std::string name = find_grid(file, path, grid_name);
  check_kind(path, name, *make_immortal<openvdb::GridBase::Ptr>(file.readGridMetadata(name)));
  return name;
}

void write_raw_grid(const std::string& path, const std::string& name, Background background,
                    const std::optional<WantedBox>& wanted, int descriptor) {
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false); // delayed loading hangs or crashes on malformed files
  const std::string grid_name = find_grid(file, path, name);
  const openvdb::GridBase& metadata =
      *make_immortal<openvdb::GridBase::Ptr>(file.readGridMetadata(grid_name));
  check_kind(path, grid_name, metadata);
  const auto read_all = [&]() -> const openvdb::GridBase& {
    return *make_immortal<openvdb::GridBase::Ptr>(file.readGrid(grid_name));
  };
  const bool crops = wanted && metadata.getGridClass() != openvdb::GRID_LEVEL_SET;
  const openvdb::GridBase& grid =
      crops ? read_part(file, path, grid_name, metadata, *wanted) : read_all();
  check_kind(path, grid_name, grid);
  // A file that ends just before a tree looks like an empty one: not so where it has more
  // elsewhere.
  const bool cropped = crops && !(grid.empty() && read_all().empty());
  if (grid.isType<openvdb::FloatGrid>())
    write_grid(path, grid_name, static_cast<const openvdb::FloatGrid&>(grid), background, cropped,
               descriptor);
  else
    write_grid(path, grid_name, static_cast<const openvdb::DoubleGrid&>(grid), background, cropped,
               descriptor);
}

} // namespace vdbeam
