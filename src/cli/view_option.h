#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vdbeam::cli {

/// Declares --view, which chooses the view transform of previews.
void add_view(CLI::App& app, std::string& view);

} // namespace vdbeam::cli
