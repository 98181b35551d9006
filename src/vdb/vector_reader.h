#pragma once

#include "vdb/vector_field.h"

namespace vdbeam {

/// Unit of a velocity's numbers: lengths per second of the grid's index space or of the world,
/// times a factor.
struct VelocityScale {
  bool index = false;
  double factor = 1;
};
VelocityScale scale_of(const VelocitySettings& settings, bool from_mantaflow);

/// Reads the velocity of a VDB; null where settings.grid is "auto" and the file has none. What
/// would cross the whole grid within a frame is an outlier. Throws as read_density_grid.
std::shared_ptr<const VectorField> read_velocity(const std::string& path,
                                                 const VelocitySettings& settings,
                                                 const ReadLimits& limits = {});

/// Whether that finds a velocity, as the names and types of the file's grids say.
bool has_velocity(const std::string& path, const std::string& grid, const ReadLimits& limits = {});

/// Colours of a VDB.
struct Colors {
  std::shared_ptr<const VectorField> field; ///< null: the file has none
  std::uint64_t limited = 0;                ///< voxels with components beyond [0, 1]
};

/// Reads colours, which are brought to [0, 1]. `grid` is a grid of vectors, three of numbers with
/// commas between them, or "auto". Throws as read_density_grid.
Colors read_colors(const std::string& path, const std::string& grid, const ReadLimits& limits = {});

} // namespace vdbeam
