#pragma once

#include "machine/memory.h"
#include "math/affine.h"
#include "math/stop_token.h"
#include "vdb/wanted_box.h"
#include "volume/color_field.h"
#include "volume/density_field.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbeam {

/// Findings and repairs while a grid was read.
struct GridRepairs {
  std::uint64_t nan = 0;      ///< values replaced by 0
  std::uint64_t infinite = 0; ///< values replaced by 0
  std::uint64_t negative = 0; ///< values replaced by 0
};

/// A density grid ready to render.
struct DensityGrid {
  DensityField field; ///< empty() where the grid holds nothing
  /// Multiplies the albedo, in the field's local coordinates; null: nothing does.
  std::shared_ptr<const ColorField> color = nullptr;
  Affine index_to_world; ///< the file's map
  GridRepairs repairs;
  std::uint64_t active_voxels = 0; ///< tiles counted by the voxels they cover
  std::vector<std::string> notes; ///< one line each, for the user (repairs, emptiness, conversions)
  bool from_mantaflow = false;    ///< as GridSummary has it
};

/// One grid of a file, as `vdbeam info` shows it.
struct GridSummary {
  std::string name;       ///< unique name, e.g. "density" or "density[1]"
  std::string value_type; ///< "float", "half", "vec3s", ...
  std::string grid_class; ///< "Fog Volume", "Level Set", "Unknown", ...
  std::string map_type;   ///< "UniformScaleMap", "AffineMap", "NonlinearFrustumMap", ...
  bool saved_as_half = false;
  std::uint64_t active_voxels = 0;
  std::uint64_t leaf_count = 0, tile_count = 0;
  Vec3<std::int64_t> index_lower,
      index_upper; ///< active bounding box, inclusive; lower > upper if empty
  Affine index_to_world;
  Boxd world_bounds;
  double voxel_size[3] = {0, 0, 0};
  double minimum = 0, maximum = 0, mean = 0; ///< over active voxels, scalar float grids only
  double background = 0;
  GridRepairs bad_values;      ///< counted, not changed; a level set has no bad negative ones
  bool from_mantaflow = false; ///< written by Mantaflow, Blender's simulator, whose Z axis is up
  /// Where the grid holds something, for framing it: the bounding box is divided into outline_steps
  /// cells along each axis; for each column of cells along z (x fastest) the first and the last
  /// cell that holds more than a hundredth of the maximum, or two numbers where the first is
  /// larger.
  std::vector<int> outline;
  static constexpr int outline_steps = 32;
};

/// How far an untrusted file may go before it is refused.
struct ReadLimits {
  double seconds = 120; ///< of wall-clock time, beside what its size takes (time_for)
  std::uint64_t bytes = free_memory(); ///< of memory
  const StopToken* stop = nullptr;     ///< ends reading by throwing Stopped
};

/// Treatment of a grid whose value far outside is not 0: a density without end is refused; of
/// other grids values equal to it count as 0.
enum class Background { refused, ignored };

/// Reads one float or half grid and bricks it, in parallel; only the leaves and tiles that `wanted`
/// needs, if given; repairs and counts then refer to those only. (All leaves of a level set, since
/// its depth is found in all of it.)
/// Throws InputError (missing file or grid, naming the grids there are; unsupported type, class or
/// map) and FrameError (corrupt file, limits exceeded), each within `limits`.
DensityGrid read_density_grid(const std::string& path, const std::string& grid_name,
                              const ReadLimits& limits = {},
                              Background background = Background::refused,
                              const std::optional<WantedBox>& wanted = {});

/// Header data of a grid that read_density_grid would read: name, type, class, map,
/// active voxels and bounds. Takes milliseconds: voxels are read only where the file was written
/// without statistics. Same errors.
GridSummary read_grid_header(const std::string& path, const std::string& grid_name,
                             const ReadLimits& limits = {});

/// Lists every grid of a file; same errors.
std::vector<GridSummary> summarize_vdb(const std::string& path, const ReadLimits& limits = {});

/// "OpenVDB 10.0.1"
std::string vdb_library_version();

} // namespace vdbeam
