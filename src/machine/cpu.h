#pragma once

#include <string>

namespace vdbeam {

/// The CPU that this runs on, as it names itself; "unknown" where the system does not tell.
std::string cpu_model();

} // namespace vdbeam
