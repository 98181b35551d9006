#pragma once

#include "vdb/vdb_reader.h"

#include <string>
#include <vector>

namespace vdbeam::cli {

/// True for grids of one number per voxel, whose value range was measured.
bool is_scalar(const GridSummary& grid);

/// Which of these grids of a file `vdbeam render FILE` would show and how, or why none.
std::string rendered_text(const std::string& file, const std::vector<GridSummary>& grids);

/// Notes about these grids before rendering, one line each.
std::vector<std::string> suspicious(const std::vector<GridSummary>& grids);

} // namespace vdbeam::cli
