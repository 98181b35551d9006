#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vdbeam::cli {

/// The manual page vdbeam(1) in the man macros, from what --help and --help-scene show.
std::string manual_page(const CLI::App& program, const std::string& version);

/// Completion for bash and zsh: commands, options, and the words that an option takes.
std::string bash_completion(const CLI::App& program);
std::string zsh_completion(const CLI::App& program);

} // namespace vdbeam::cli
