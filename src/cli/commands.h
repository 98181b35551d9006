#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <span>

namespace vdbeam::cli {

/// One command of the program: declares its options and gives the function that runs it. That
/// function returns the exit code; it throws Error for everything that goes wrong.
using CommandRun = std::function<int()>;
CommandRun add_render(CLI::App& app);
CommandRun add_info(CLI::App& app);
CommandRun add_init(CLI::App& app);
CommandRun add_live(CLI::App& app);
CommandRun add_plan(CLI::App& app);
CommandRun add_compare(CLI::App& app);
CommandRun add_merge(CLI::App& app);
CommandRun add_summary(CLI::App& app);
CommandRun add_farm(CLI::App& app);
CommandRun add_help(CLI::App& app);
CommandRun add_generate(CLI::App& app);

struct Command {
  const char* name;
  const char* description;
  CommandRun (*add)(CLI::App& app);
};

/// Every command, in the order of --help. A new one is its file and a line of this table.
std::span<const Command> commands();

} // namespace vdbeam::cli
