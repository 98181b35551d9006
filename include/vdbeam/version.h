#pragma once

namespace vdbeam {

/// Version of the library, "major.minor.patch".
const char* version();

} // namespace vdbeam
