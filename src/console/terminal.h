#pragma once

#include <string>

namespace vdbeam::cli {

/// True where `descriptor` is a terminal that understands escape sequences: not a file, not a pipe,
/// and TERM is neither unset nor "dumb".
bool is_smart_terminal(int descriptor);

/// Columns of the terminal now, which a user may change at any time; 80 if unknown.
int terminal_columns(int descriptor);
/// Columns for text on stdout that people read: those of the terminal, 80 to 120.
std::size_t text_columns();

/// The line in red where stderr is a terminal with colours and NO_COLOR (no-color.org) is not set.
std::string error_line(const std::string& line);

} // namespace vdbeam::cli
