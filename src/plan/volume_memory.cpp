#include "grids/edited_field.h"
#include "grids/fog_grid.h"
#include "machine/memory.h"
#include "plan/grids_once.h"
#include "plan/memory_model.h"
#include "prepare/read_volumes.h"
#include "vdb/vector_reader.h"
#include "vdbeam/error.h"
#include "volume/emission_field.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace vdbeam {
namespace {

constexpr std::uint64_t brick_bytes = DensityField::brick_size * sizeof(float);
constexpr std::uint64_t leaf_values = 512;
/// Index table and largest values of a field, per cell.
constexpr std::uint64_t table_bytes = sizeof(std::int32_t) + sizeof(float);
/// Memory of a leaf of OpenVDB's tree beyond its values [bytes]: masks, origin, the allocator.
constexpr std::uint64_t leaf_overhead = 112;
/// A process that reads a file takes so much beyond the grid: pages that it copies, buffers.
constexpr std::uint64_t reader_bytes = std::uint64_t{8} << 20;
/// Ranges of a leaf's values, and its origin, while bricks are made.
constexpr std::uint64_t leaf_range_bytes = 64 + 12;
/// A refined field is put together from columns, which hold its values once more.
constexpr double while_refined = 2;
/// Bricks that a velocity brings something to, beside those of the grid at rest.
constexpr double moved_share = 1.15;

/// A field and the most that is taken while it is made, itself included.
struct FieldMemory {
  CellSet set;
  std::uint64_t bytes = 0, peak = 0;
  Affine to_world; ///< of its cells
  /// Cells of the grid before refinement and displacement: its voxels show best what the camera
  /// sees.
  CellSet grid;
  Affine grid_to_world;
};

std::uint64_t field_bytes(const CellSet& set) {
  return set.count() * brick_bytes + set.cells() * table_bytes;
}

Affine cells_to_world(const Affine& index_to_world, double scale) {
  Affine cells = index_to_world;
  for (Vec3d& row : cells.rows)
    row = row * (scale * cell_width);
  return cells;
}

class VolumeEstimate {
public:
  VolumeEstimate(const Scene& scene, const VolumeSettings& volume, GridsOnce& grids)
      : scene_(scene), volume_(volume), grids_(grids) {}

  /// The grid of this name, refined and displaced as the volume has it.
  FieldMemory source(const std::string& name) {
    if (volume_.fog.made())
      return fog();
    const GridShape& shape = shape_of(name);
    const GridSummary& header = grids_.header(volume_.file, name);
    std::optional<WantedBox::Voxels> wanted;
    if (const auto box = wanted_box(volume_, nullptr);
        box && scene_.moments.empty() && header.grid_class != "Level Set")
      wanted = box->voxels(header.index_to_world);
    FieldMemory field;
    field.set = CellSet(shape, 1, 0, wanted);
    field.bytes = field_bytes(field.set);
    field.peak = reading_bytes(shape, field.set);
    field.to_world = field.grid_to_world = cells_to_world(header.index_to_world, 1);
    field.grid = field.set;
    if (volume_.interpolation == Interpolation::cubic)
      refine(shape, wanted, header.index_to_world, field);
    if (volume_.noise.amplitude > 0)
      displace(field);
    return field;
  }

  const GridShape& shape_of(const std::string& name) {
    if (!volume_.fog.made())
      return grids_.shape(volume_.file, name);
    if (!fog_shape_)
      fog_shape_ = fog_grid_shape(volume_);
    return *fog_shape_;
  }

private:
  /// The field of a volume without a file, which is made with its noise.
  FieldMemory fog() {
    FieldMemory field;
    field.grid = field.set = CellSet(shape_of(volume_.density), 1, 0);
    field.bytes = fog_bytes(volume_);
    constexpr double while_made = 1.1; // the cells of its bricks
    field.peak = times(while_made, field.bytes);
    field.to_world = field.grid_to_world = cells_to_world(fog_header(volume_).index_to_world, 1);
    return field;
  }

  /// OpenVDB's tree and the memory file beside it, or the bricks that replace the file.
  static std::uint64_t reading_bytes(const GridShape& shape, const CellSet& set) {
    const std::uint64_t leaves = shape.leaf_count;
    const std::uint64_t file = leaves * leaf_values * sizeof(float);
    const std::uint64_t child = reader_bytes + file + shape.node_bytes +
                                leaves * (leaf_values * shape.value_bytes + leaf_overhead);
    constexpr std::uint64_t batch = 4096 * brick_bytes;
    const std::uint64_t bricks = field_bytes(set);
    const std::uint64_t parent = leaves * leaf_range_bytes + set.cells() * sizeof(std::int32_t) +
                                 std::max(file, bricks) + std::min(batch, bricks);
    return std::max(child, parent);
  }

  /// A step of the preparation that makes a field from another.
  static void replace(FieldMemory& field, CellSet set, double while_made) {
    const std::uint64_t bytes = field_bytes(set);
    field.peak = std::max(field.peak, field.bytes + times(while_made, bytes));
    field.bytes = bytes;
    field.set = std::move(set);
  }

  void refine(const GridShape& shape, const std::optional<WantedBox::Voxels>& wanted,
              const Affine& index_to_world, FieldMemory& field) {
    replace(field, CellSet(shape, 2, 3, wanted), while_refined);
    field.to_world = cells_to_world(index_to_world, 0.5);
  }

  void displace(FieldMemory& field) {
    const Affine from_world = field.to_world.inverse();
    Vec3<int> lower, upper;
    for (int a = 0; a < 3; ++a) {
      const Vec3d& row = from_world.rows[static_cast<std::size_t>(a)];
      const double most =
          volume_.noise.amplitude * (std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
      constexpr double far = 1 << 24; // cells, more than any table has
      if (!(most < far))
        throw FrameError(volume_.file + ": is displaced too far for any table of its blocks");
      lower[a] = static_cast<int>(std::floor(-0.25 - most));
      upper[a] = static_cast<int>(std::floor(1.125 + most));
    }
    replace(field, field.set.spread(lower, upper), 1);
  }

  const Scene& scene_;
  const VolumeSettings& volume_;
  GridsOnce& grids_;
  std::optional<GridShape> fog_shape_;
};

/// Whether the frame's shutter sees the volume at several moments.
bool moves(const Scene& scene, const VolumeSettings& volume) {
  return !scene.moments.empty() && volume.present && !volume.fog.made() &&
         volume.velocity.grid != "none" && volume.velocity.scale != 0 &&
         has_velocity(volume.file, volume.velocity.grid);
}

/// The mean optical depth of volumes, from the sum of their voxels and the shadows of their cells.
class MeanDepth {
public:
  void add(const VolumeSettings& volume, const GridShape& shape, const CellSet& cells,
           const Affine& to_world) {
    const bool edited = volume.remap.changes() || !volume.mask.empty() || !volume.add.empty() ||
                        (volume.box_lower.has_value() && !volume.fog.made());
    known_ = known_ && shape.value_sum >= 0 && !edited;
    const auto edge = [&](int a) {
      const std::array<Vec3d, 3>& rows = to_world.rows;
      return Vec3d{rows[0][a], rows[1][a], rows[2][a]};
    };
    const Vec3d columns = cells.columns();
    for (int a = 0; a < 3; ++a)
      area_ += columns[a] / 3 * length(cross(edge((a + 1) % 3), edge((a + 2) % 3)));
    const Rgb& by_channel = volume.extinction_scale;
    const double scale = static_cast<double>(by_channel.x + by_channel.y + by_channel.z) / 3;
    constexpr double width = cell_width;
    const double voxel = std::abs(dot(edge(0), cross(edge(1), edge(2)))) / (width * width * width);
    opacity_ += volume.extinction * scale * shape.value_sum * voxel;
  }

  /// Below 0 where it is not known.
  double value() const { return !known_ ? -1 : area_ > 0 ? opacity_ / area_ : 0; }

private:
  bool known_ = true;
  double opacity_ = 0, area_ = 0; ///< integral of the extinction [area], and what it shades [area]
};

struct VolumeMemory {
  std::uint64_t kept = 0, peak = 0; ///< `peak`: while it is prepared, in all
  std::uint64_t sources = 0;        ///< kept for the moments beside it
  std::uint64_t in_file = 0;        ///< of a field of its density as the file has it
  bool moves = false;
};

void take_density(const VolumeSettings& volume, VolumeEstimate& estimate, VolumesMemory& all,
                  VolumeMemory& memory, MeanDepth& depth) {
  FieldMemory field = estimate.source(volume.density);
  std::uint64_t others = 0;
  for (std::string names = volume.add + "," + volume.mask; !names.empty();) {
    const std::size_t comma = names.find(',');
    std::string name = names.substr(0, comma);
    names = comma == names.npos ? "" : names.substr(comma + 1);
    name.erase(0, name.find_first_not_of(' '));
    if (name.empty())
      continue;
    const FieldMemory other = estimate.source(name);
    memory.peak = std::max(memory.peak, field.bytes + others + other.peak);
    others += other.bytes;
  }
  if (others > 0)
    field.peak = std::max(field.peak, 2 * field.bytes + others);
  const bool edited =
      volume.remap.changes() || !volume.mask.empty() || (volume.box_lower && !volume.fog.made());
  if (edited)
    field.peak = std::max(field.peak, 2 * field.bytes);
  memory.peak = std::max(memory.peak, field.peak);
  memory.kept += field.bytes;
  memory.in_file = field_bytes(CellSet(estimate.shape_of(volume.density), 1, 0));
  if (memory.moves && edited)
    memory.sources += field.bytes;
  if (!volume.color_grid.empty()) {
    const std::uint64_t colors = 3 * field.set.count() * brick_bytes;
    memory.kept += 2 * colors; // the grid that was read stays beside them
    memory.peak = std::max(memory.peak, memory.kept + colors);
  }
  all.cells += field.set.cells();
  const Affine to_world = Affine::from_matrix(volume.transform).after(field.grid_to_world);
  depth.add(volume, estimate.shape_of(volume.density), field.grid, to_world);
  all.seen.push_back({std::move(field.grid), to_world, volume.absorbs_or_scatters()});
}

void take_emission(const VolumeSettings& volume, VolumeEstimate& estimate, VolumesMemory& all,
                   VolumeMemory& memory) {
  std::uint64_t made_from = 0;
  CellSet glows, seen;
  Affine place;
  // What glows has the shape of the intensity where there is one.
  for (const std::string& name : {volume.emission.temperature, volume.emission.intensity}) {
    if (name.empty())
      continue;
    FieldMemory field = estimate.source(name);
    memory.peak = std::max(memory.peak, memory.kept + made_from + field.peak);
    made_from += field.bytes;
    glows = std::move(field.set);
    seen = std::move(field.grid);
    place = field.grid_to_world;
  }
  const std::uint64_t glow = glows.count() * brick_bytes * 3 + glows.cells() * 4;
  memory.peak = std::max(memory.peak, memory.kept + made_from + glow);
  memory.kept += glow;
  memory.in_file = std::max(memory.in_file, made_from);
  if (memory.moves)
    memory.sources += made_from;
  all.seen.push_back({std::move(seen), Affine::from_matrix(volume.transform).after(place), false});
}

std::string reason(const VolumeSettings& volume) {
  if (volume.interpolation == Interpolation::cubic)
    return "interpolation = \"cubic\"";
  return volume.noise.amplitude > 0 ? "noise_amplitude" : "";
}

} // namespace

VolumesMemory estimate_volumes(const Scene& scene) {
  VolumesMemory all;
  MeanDepth depth;
  std::uint64_t most = 0, sources = 0, moving = 0;
  GridsOnce grids;
  std::set<std::string> known; // volumes of the same values share them
  for (const VolumeSettings& volume : scene.volumes) {
    if (!volume.present)
      continue;
    VolumeEstimate estimate(scene, volume, grids);
    VolumeMemory memory;
    memory.moves = moves(scene, volume);
    const bool density = volume.needs_density(), glows = volume.glows();
    if (density)
      take_density(volume, estimate, all, memory, depth);
    if (density && !memory.moves && !known.insert(density_identity(volume)).second)
      memory = {};
    const VolumeMemory before_glow = memory;
    if (glows)
      take_emission(volume, estimate, all, memory);
    if (glows && !memory.moves && !known.insert("glow" + emission_identity(volume)).second)
      memory = before_glow;
    if (memory.moves) {
      moving += times(moved_share, memory.kept);
      // A velocity has three numbers where the density has one.
      sources += memory.sources + 3 * memory.in_file;
      memory.peak += 3 * memory.in_file;
    }
    const std::uint64_t before = all.still + sources;
    all.reading = std::max(all.reading, before + memory.peak);
    all.still += memory.kept;
    if (memory.peak > most) {
      most = memory.peak;
      all.largest = volume.file;
      all.why = reason(volume);
    }
  }
  all.depth = depth.value();
  all.kept = all.still + sources;
  if (moving > 0) {
    const std::uint64_t room = std::max<std::uint64_t>(2, granted_memory() / 4 / moving);
    all.moments = std::min<std::uint64_t>(
        {scene.moments.size(), static_cast<std::uint64_t>(scene.render.passes.value_or(1 << 20)),
         room});
    all.kept += all.moments * moving;
    all.reading += moving;
  }
  return all;
}

} // namespace vdbeam
