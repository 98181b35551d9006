#include "vdb/vector_parse.h"

#include "machine/mapped_file.h"
#include "text/text.h"
#include "vdb/raw_grid.h"
#include "vdb/vdb_names.h"
#include "vdb/vdb_parse.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>

namespace vdbeam {
namespace {

constexpr float missing = std::numeric_limits<float>::quiet_NaN();

/// How programs call such grids; "{}" is a component.
struct UsualNames {
  const char* what; ///< in messages
  std::vector<const char*> vectors, triples;
  std::vector<std::string> components; ///< one letter each
};

const UsualNames& usual_names(VectorMeaning meaning) {
  // Blender and EmberGen: velocity; Houdini: vel, v.
  static const UsualNames velocity{"a velocity",
                                   {"velocity", "vel", "v", "velocities", "motion"},
                                   {"vel.{}", "vel{}", "vel_{}", "velocity.{}", "velocity_{}",
                                    "velocity{}", "v{}", "v.{}", "v_{}"},
                                   {"xyz"}};
  static const UsualNames color{
      "a colour",
      {std::begin(color_grid_names), std::end(color_grid_names)},
      {"Cd.{}", "Cd{}", "Cd_{}", "color.{}", "color_{}", "albedo.{}", "albedo_{}"},
      {"xyz", "rgb"}};
  return meaning == VectorMeaning::velocity ? velocity : color;
}

struct NamedGrid {
  std::string name;
  bool vectors = false, numbers = false;
};

std::vector<NamedGrid> list_grids(openvdb::io::File& file) {
  std::vector<NamedGrid> grids;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const auto& grid =
        *make_immortal<openvdb::GridBase::Ptr>(file.readGridMetadata(name.gridName()));
    const std::string type = grid.valueType();
    grids.push_back(
        {name.gridName(), type == "vec3s" || type == "vec3d", type == "float" || type == "double"});
  }
  return grids;
}

/// The grid of this name, capitals aside.
const NamedGrid* find(const std::vector<NamedGrid>& grids, const std::string& name) {
  for (const NamedGrid& grid : grids)
    if (grid.name == name)
      return &grid;
  for (const NamedGrid& grid : grids)
    if (lower_case(grid.name) == lower_case(name))
      return &grid;
  return nullptr;
}

/// The grids that `name` stands for, "{}" being one of three letters; empty where they are not
/// there.
std::vector<std::string> find_triple(const std::vector<NamedGrid>& grids, const std::string& name,
                                     const std::string& letters) {
  std::vector<std::string> found;
  for (const char letter : letters)
    if (const NamedGrid* grid = find(grids, fmt::format(fmt::runtime(name), letter));
        grid && grid->numbers)
      found.push_back(grid->name);
  return found.size() == 3 ? found : std::vector<std::string>{};
}

std::vector<std::string> find_usual(const std::vector<NamedGrid>& grids, const UsualNames& names) {
  for (const char* name : names.vectors)
    if (const NamedGrid* grid = find(grids, name); grid && grid->vectors)
      return {grid->name};
  for (const char* name : names.triples)
    for (const std::string& letters : names.components)
      if (const auto found = find_triple(grids, name, letters); !found.empty())
        return found;
  return {};
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',')
      parts.emplace_back();
    else if (c != ' ')
      parts.back() += c;
  }
  return parts;
}

/// The value of one component as a float.
float component_of(float value, int) {
  return value;
}
float component_of(double value, int) {
  return static_cast<float>(value);
}
template <class T>
float component_of(const openvdb::math::Vec3<T>& value, int component) {
  return static_cast<float>(value[component]);
}

template <class Grid>
void write_component(const Grid& grid, int component, int descriptor) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  static_assert(Leaf::SIZE == leaf_size);
  std::vector<const Leaf*> leaves;
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
    leaves.push_back(leaf.getLeaf());
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf* a, const Leaf* b) { return a->origin() < b->origin(); });
  std::vector<RawTile> tiles;
  auto tile = grid.tree().cbeginValueOn();
  tile.setMaxDepth(Grid::TreeType::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox box = tile.getBoundingBox();
    tiles.push_back({{box.min().x(), box.min().y(), box.min().z()},
                     static_cast<std::int32_t>(box.dim().x()),
                     component_of(tile.getValue(), component)});
  }
  RawGridHeader header;
  const openvdb::math::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      header.index_to_world[static_cast<std::size_t>(4 * i + j)] = matrix(j, i);
  header.staggered = grid.getGridClass() == openvdb::GRID_STAGGERED;
  header.from_mantaflow = static_cast<bool>(grid["file_base_resolution"]);
  header.leaf_count = leaves.size();
  header.tile_count = tiles.size();
  std::array<char, RawGridHeader::values_offset> page{};
  std::memcpy(page.data(), &header, sizeof header);
  write_all(descriptor, page.data(), page.size());
  std::vector<float> values(leaf_size);
  for (const Leaf* leaf : leaves) {
    for (openvdb::Index i = 0; i < leaf_size; ++i)
      values[i] = leaf->isValueOn(i) ? component_of(leaf->getValue(i), component) : missing;
    write_all(descriptor, values.data(), values.size() * sizeof(float));
  }
  for (const Leaf* leaf : leaves) {
    const std::int32_t origin[3] = {leaf->origin().x(), leaf->origin().y(), leaf->origin().z()};
    write_all(descriptor, origin, sizeof origin);
  }
  write_all(descriptor, tiles.data(), tiles.size() * sizeof(RawTile));
}

} // namespace

void write_vector_names(const std::string& path, const std::string& wanted, VectorMeaning meaning,
                        int descriptor) {
  const UsualNames& usual = usual_names(meaning);
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false);
  const std::vector<NamedGrid> grids = list_grids(file);
  std::vector<std::string> names;
  if (wanted == "auto") {
    names = find_usual(grids, usual);
  } else {
    const std::vector<std::string> parts = split(wanted);
    if (parts.size() != 1 && parts.size() != 3)
      throw InputError(
          fmt::format("{}: \"{}\" cannot be {}: it must name one grid of vectors, or three "
                      "grids with commas between them",
                      path, wanted, usual.what));
    for (const std::string& part : parts) {
      const NamedGrid* grid = find(grids, part);
      if (!grid) {
        std::vector<std::string> all;
        for (const NamedGrid& other : grids)
          all.push_back(other.name);
        throw InputError(missing_grid_message(path, part, all));
      }
      if (parts.size() == 1 ? !grid->vectors : !grid->numbers)
        throw InputError(fmt::format("{}: grid \"{}\" cannot be {}: it must hold {}", path, part,
                                     usual.what,
                                     parts.size() == 1 ? "vectors of three" : "numbers"));
      names.push_back(grid->name);
    }
  }
  for (const std::string& name : names)
    write_all(descriptor, (name + '\n').data(), name.size() + 1);
}

void write_raw_component(const std::string& path, const std::string& name, int component,
                         VectorMeaning meaning, int descriptor) {
  auto& file = make_immortal<openvdb::io::File>(path);
  file.open(false); // delayed loading hangs or crashes on malformed files
  const openvdb::GridBase& grid = *make_immortal<openvdb::GridBase::Ptr>(file.readGrid(name));
  if (!grid.transform().isLinear())
    throw InputError(fmt::format("{}: grid \"{}\" has a transform that is not affine", path, name));
  if (grid.isType<openvdb::Vec3SGrid>())
    write_component(static_cast<const openvdb::Vec3SGrid&>(grid), component, descriptor);
  else if (grid.isType<openvdb::Vec3DGrid>())
    write_component(static_cast<const openvdb::Vec3DGrid&>(grid), component, descriptor);
  else if (grid.isType<openvdb::DoubleGrid>())
    write_component(static_cast<const openvdb::DoubleGrid&>(grid), component, descriptor);
  else if (grid.isType<openvdb::FloatGrid>())
    write_component(static_cast<const openvdb::FloatGrid&>(grid), component, descriptor);
  else
    throw InputError(fmt::format("{}: grid \"{}\" cannot be {}: it holds {}", path, name,
                                 usual_names(meaning).what, grid.valueType()));
}

} // namespace vdbeam
