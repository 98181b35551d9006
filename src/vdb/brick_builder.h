#pragma once

#include "vdb/raw_grid.h"
#include "vdb/vdb_reader.h"
#include "volume/density_field.h"
#include "volume/field_limits.h"

#include <string>

namespace vdbeam {

struct BrickedGrid {
  DensityField field;
  GridRepairs repairs; ///< tiles count once per voxel they cover
};

/// Mends a grid's values (NaN, infinite and negative ones become 0; signed distances become fog as
/// by OpenVDB's sdfToFogVolume) and cuts it in bricks, in parallel; the result does not depend on
/// the number of threads. Peak memory on top of the leaves is the result's, and leaves are released
/// as they are consumed.
/// Throws FrameError, opening with `label`, where the index table would exceed 2^28 cells or the
/// field the limit, and Stopped.
BrickedGrid build_bricks(RawGrid& grid, const std::string& label, const FieldLimits& limits);

} // namespace vdbeam
