#pragma once

#include <string>

namespace vdbeam {

/// Most names that dots may join in one key. No key of a scene has more than four.
inline constexpr std::size_t most_dotted_names = 16;

/// Refuses TOML whose keys lead deeper than any scene's, before toml++ sees it: its tree is built
/// and destroyed recursively, so a key of many dots would exhaust the stack. Throws InputError
/// with `source` and the line.
void check_nesting(const std::string& text, const std::string& source);

} // namespace vdbeam
