#pragma once

#include "vdb/vdb_reader.h"
#include "volume/field_limits.h"

namespace vdbeam {

/// The grid by tricubic interpolation, on a lattice twice as fine: a uniform cubic B-spline through
/// which no cube shows, as Cycles interpolates (Sigg and Hadwiger, GPU Gems 2, chapter 20). Its
/// values are never negative nor greater than the grid's, and their sum is kept; in between it is
/// linear, like every grid. Takes eight times the memory and more: FrameError, opening with
/// `label`, where that is over the limit. Throws Stopped.
DensityGrid refined_grid(const DensityGrid& grid, const std::string& label,
                         const FieldLimits& limits);

} // namespace vdbeam
