#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// One line about a command line that CLI11 refuses: what is wrong and what was probably meant.
/// `words` are those after the program's name.
std::string usage_error(const CLI::App& program, const std::vector<std::string>& words,
                        const CLI::ParseError& error);

} // namespace vdbeam::cli
