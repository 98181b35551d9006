#pragma once

#include <string>

namespace vdbeam {

/// "there is no file PATH", the path made absolute, and what was probably meant: the file of the
/// nearest name beside it, the sequence that its pattern should name, or a `~` or `$NAME` that
/// nobody expanded.
std::string missing_file_text(const std::string& path);

/// "; ~ is not expanded here ..." for a path with a `~` or `$NAME` that only a shell would expand;
/// empty for others. `$F` and `$F4` stand for the frame number and are not meant.
std::string unexpanded_hint(const std::string& path);

} // namespace vdbeam
