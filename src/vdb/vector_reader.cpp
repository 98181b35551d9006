#include "vdb/vector_reader.h"
#include "vdb/guarded_read.h"
#include "vdb/raw_grid.h"
#include "vdb/vector_parse.h"
#include "vdbeam/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdbeam {
namespace {

constexpr std::size_t brick_size = static_cast<std::size_t>(cell_width) * cell_width * cell_width;
constexpr double most_cells = 1 << 28;

std::vector<std::string> lines_of(const MappedFile& file) {
  const std::string text(reinterpret_cast<const char*>(file.data()), file.size());
  std::vector<std::string> lines;
  for (std::size_t begin = 0, end; (end = text.find('\n', begin)) != std::string::npos;
       begin = end + 1)
    lines.push_back(text.substr(begin, end - begin));
  return lines;
}

/// One component as it was read.
struct Component {
  MappedFile file;
  RawGridHeader header;
  RawGrid grid;
};

/// Puts components together, cell by cell.
class Assembler {
public:
  explicit Assembler(const std::vector<Component>& components) : components_(components) {}

  VectorField::Values assemble(const std::string& label) {
    if (!find_bounds())
      return {};
    double cells = 1;
    for (int a = 0; a < 3; ++a) {
      values_.cells[a] = static_cast<int>((upper_[a] - lower_[a]) / cell_width);
      cells *= values_.cells[a];
    }
    if (cells > most_cells)
      throw FrameError(label + ": its voxels lie too far apart");
    values_.origin = lower_;
    values_.table.assign(static_cast<std::size_t>(cells), -1);
    values_.means.assign(static_cast<std::size_t>(cells),
                         Vec3f(std::numeric_limits<float>::quiet_NaN()));
    for (int c = 0; c < 3; ++c)
      add_tiles(c);
    for (int c = 0; c < 3; ++c)
      add_leaves(c);
    return std::move(values_);
  }

private:
  bool find_bounds() {
    const auto extend = [&](const std::int32_t* origin, std::int64_t size) {
      for (int a = 0; a < 3; ++a) {
        lower_[a] = std::min<std::int64_t>(lower_[a], origin[a]);
        upper_[a] = std::max<std::int64_t>(upper_[a], origin[a] + size);
      }
    };
    for (const Component& component : components_) {
      for (std::size_t leaf = 0; leaf < component.grid.leaf_count; ++leaf)
        extend(component.grid.leaf_origins + 3 * leaf, cell_width);
      for (const RawTile& tile : component.grid.tiles)
        extend(tile.origin.data(), tile.width);
    }
    return lower_.x < upper_.x;
  }
  std::size_t cell_of(const std::int32_t* origin) const {
    std::size_t offset = 0;
    for (int a = 0; a < 3; ++a)
      offset = offset * static_cast<std::size_t>(values_.cells[a]) +
               static_cast<std::size_t>((origin[a] - lower_[a]) / cell_width);
    return offset;
  }
  void add_tiles(int c) {
    for (const RawTile& tile : components_[static_cast<std::size_t>(c)].grid.tiles)
      for (std::int32_t i = 0; i < tile.width; i += cell_width)
        for (std::int32_t j = 0; j < tile.width; j += cell_width)
          for (std::int32_t k = 0; k < tile.width; k += cell_width) {
            const std::int32_t origin[3] = {tile.origin[0] + i, tile.origin[1] + j,
                                            tile.origin[2] + k};
            values_.means[cell_of(origin)][c] = tile.value;
          }
  }
  void add_leaves(int c) {
    const RawGrid& grid = components_[static_cast<std::size_t>(c)].grid;
    for (std::size_t leaf = 0; leaf < grid.leaf_count; ++leaf) {
      const std::size_t cell = cell_of(grid.leaf_origins + 3 * leaf);
      std::int32_t& brick = values_.table[cell];
      if (brick < 0) {
        brick = static_cast<std::int32_t>(values_.bricks.size() / brick_size);
        values_.bricks.resize(values_.bricks.size() + brick_size, values_.means[cell]);
      }
      for (std::size_t v = 0; v < brick_size; ++v)
        values_.bricks[static_cast<std::size_t>(brick) * brick_size + v][c] =
            grid.leaf_values[leaf * leaf_size + v];
    }
  }

  const std::vector<Component>& components_;
  VectorField::Values values_;
  Vec3<std::int64_t> lower_{std::int64_t{1} << 40, std::int64_t{1} << 40, std::int64_t{1} << 40};
  Vec3<std::int64_t> upper_{-(std::int64_t{1} << 40), -(std::int64_t{1} << 40),
                            -(std::int64_t{1} << 40)};
};

/// The longest velocity that does not cross the whole lattice within a frame.
double longest_velocity(const VectorField::Values& values, const VelocitySettings& settings) {
  const Vec3d size = Vec3d(values.cells) * double{cell_width};
  const VelocityScale meaning = scale_of(settings, values.from_mantaflow);
  const double diagonal = meaning.index ? length(size) : length(values.index_to_world.vector(size));
  const double scale = std::abs(meaning.factor);
  return scale > 0 ? diagonal * settings.fps / scale : std::numeric_limits<double>::infinity();
}

/// Reads a grid of vectors, or three of numbers; empty where `wanted` is "auto" and there is none.
VectorField::Values read_vectors(const std::string& path, const std::string& wanted,
                                 VectorMeaning meaning, const ReadLimits& limits) {
  const std::vector<std::string> names = lines_of(read_guarded(
      path, limits, [&](int output) { write_vector_names(path, wanted, meaning, output); }));
  if (names.empty())
    return {};
  std::vector<Component> components(3);
  for (int c = 0; c < 3; ++c) {
    const std::string& name = names.size() == 3 ? names[static_cast<std::size_t>(c)] : names[0];
    Component& component = components[static_cast<std::size_t>(c)];
    component.file = read_guarded(path, limits, [&](int output) {
      write_raw_component(path, name, names.size() == 3 ? 0 : c, meaning, output);
    });
    component.grid =
        view_raw_grid(fmt::format("{}: grid \"{}\"", path, name), component.file, component.header);
    if (component.header.index_to_world != components[0].header.index_to_world)
      throw InputError(fmt::format("{}: the grids {}, {} and {} must have the same transform", path,
                                   names[0], names[1], names[2]));
  }
  const std::string label = fmt::format("{}: grid \"{}\"", path, names[0]);
  VectorField::Values values = Assembler(components).assemble(label);
  values.index_to_world = Affine::from_matrix(components[0].header.index_to_world);
  if (!(std::abs(values.index_to_world.determinant()) > 0))
    throw InputError(label + " has a transform that is singular or not finite");
  values.staggered = components[0].header.staggered != 0;
  values.from_mantaflow = components[0].header.from_mantaflow != 0;
  return values;
}

/// Brings colours to [0, 1]; returns how many were beyond. NaN stays.
std::uint64_t limit_colors(std::vector<Vec3f>& colors) {
  std::uint64_t limited = 0;
  for (Vec3f& color : colors) {
    const Vec3f before = color;
    for (int c = 0; c < 3; ++c)
      if (std::isfinite(color[c]))
        color[c] = std::clamp(color[c], 0.0f, 1.0f);
    limited += (before.x != color.x && !std::isnan(before.x)) ||
               (before.y != color.y && !std::isnan(before.y)) ||
               (before.z != color.z && !std::isnan(before.z));
  }
  return limited;
}

} // namespace

VelocityScale scale_of(const VelocitySettings& settings, bool from_mantaflow) {
  // Blender runs Mantaflow with a step of 0.1 units for a frame of 1/25 s (at a time scale of 1).
  constexpr double mantaflow_units = 2.5;
  if (settings.units == VelocityUnits::automatic && from_mantaflow)
    return {true, mantaflow_units * settings.scale};
  return {settings.units == VelocityUnits::index, settings.scale};
}

std::shared_ptr<const VectorField>
read_velocity(const std::string& path, const VelocitySettings& settings, const ReadLimits& limits) {
  VectorField::Values values = read_vectors(path, settings.grid, VectorMeaning::velocity, limits);
  if (values.table.empty() && settings.grid == "auto")
    return nullptr;
  const double longest = longest_velocity(values, settings);
  return std::make_shared<const VectorField>(std::move(values), longest);
}

bool has_velocity(const std::string& path, const std::string& grid, const ReadLimits& limits) {
  return read_guarded(path, limits, [&](int output) {
           write_vector_names(path, grid, VectorMeaning::velocity, output);
         }).size() > 0;
}

Colors read_colors(const std::string& path, const std::string& grid, const ReadLimits& limits) {
  VectorField::Values values = read_vectors(path, grid, VectorMeaning::color, limits);
  Colors colors;
  if (values.table.empty())
    return colors;
  // Tiles are represented by their value; leaves have bricks.
  std::uint64_t tiles = limit_colors(values.means);
  colors.limited = limit_colors(values.bricks) + tiles * brick_size;
  colors.field = std::make_shared<const VectorField>(std::move(values),
                                                     std::numeric_limits<double>::infinity());
  return colors;
}

} // namespace vdbeam
