#pragma once

#include <cstddef>
#include <string>

namespace vdbeam {

/// A name and its description in two columns, the description wrapped within `width` columns in
/// its own, which begins at `indent`; with a line break at the end.
std::string two_columns(const std::string& name, const std::string& description, std::size_t indent,
                        std::size_t width);

} // namespace vdbeam
