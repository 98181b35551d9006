#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// How programs call grids of colours. Houdini: Cd; Blender: color.
inline constexpr const char* color_grid_names[] = {"Cd", "color", "albedo"};

/// The grid that is meant by `wanted`: the one of this name, or the only one that differs from it
/// in capitals alone; empty where there is none.
std::string same_grid_name(const std::string& wanted, const std::vector<std::string>& names);

/// The line for a grid that a file does not have: lists those there are and suggests the nearest.
std::string missing_grid_message(const std::string& path, const std::string& wanted,
                                 const std::vector<std::string>& names);

} // namespace vdbeam
