#pragma once

#include "vdb/vdb_reader.h"
#include "vdbeam/volume_edits.h"
#include "volume/field_limits.h"

#include <string>
#include <vector>

namespace vdbeam {

/// The sum of grids, at the lattice points of the first that is not empty; between those the others
/// count as their trilinear values there. Throws FrameError, opening with `label`, where the result
/// would exceed the limit, and Stopped.
DensityGrid sum_of_grids(std::vector<DensityGrid> grids, const std::string& label,
                         const FieldLimits& limits);

/// The grid displaced by noise: the value at each lattice point x is that at x + d(x), where d is
/// the noise of the settings. What the field holds bounds it as any field's values do, so majorants
/// stay exact. Throws as above.
DensityGrid displaced_grid(const DensityGrid& grid, const NoiseSettings& noise,
                           const std::string& label, const FieldLimits& limits);

} // namespace vdbeam
