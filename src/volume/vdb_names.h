#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// The line for a grid that a file does not have: lists those there are and suggests the nearest.
std::string missing_grid_message(const std::string& path, const std::string& wanted,
                                 const std::vector<std::string>& names);

} // namespace vdbeam
