#pragma once

#include <string>

namespace vdbeam {

/// The model name of this machine's CPU; "unknown" where the system does not report it.
std::string cpu_model();

} // namespace vdbeam
