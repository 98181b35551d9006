#pragma once

#include <string>

namespace vdbeam {

/// Refuses what is no deep EXR of scan lines, and one that is cut short: the numbers of samples of
/// all its rows are read, and not the samples. Throws InputError.
void check_deep_exr(const std::string& path);

} // namespace vdbeam
