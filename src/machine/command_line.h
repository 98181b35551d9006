#pragma once

#include <string>
#include <vector>

namespace vdbeam {

/// The words with which this program was started, its own name first; empty where the system does
/// not report them.
std::vector<std::string> command_line();

} // namespace vdbeam
