#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vdbeam {

/// Names and versions of vdbeam and the libraries that affect the picture or the files: ("vdbeam",
/// "0.1.0"), ("OpenVDB", ...), ("oneTBB", ...), ("OpenEXR", ...), ("SIMD", target).
std::vector<std::pair<std::string, std::string>> component_versions();

} // namespace vdbeam
