#pragma once

#include <cstddef>
#include <string>

namespace vdbeam {

/// Remedy for a syntax error, beginning with "; ", or "". `reason` is toml++'s words
/// for it, `text` the file, `line` the line of the error, from 1.
std::string toml_remedy(const std::string& reason, const std::string& text, std::size_t line);

} // namespace vdbeam
