#include "cli/commands.h"
#include "cli/streams.h"

#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

/// `vdbeam help farm slurm` is `vdbeam farm slurm --help`.
std::string help_of(const CLI::App& program, const std::vector<std::string>& names) {
  const CLI::App* command = &program;
  std::string before;
  for (const std::string& name : names) {
    std::vector<std::string> known;
    const CLI::App* found = nullptr;
    for (const CLI::App* sub : command->get_subcommands([](const CLI::App*) { return true; })) {
      known.push_back(sub->get_name());
      found = sub->get_name() == name ? sub : found;
    }
    const auto near = nearest_word(name, known);
    if (!found)
      throw InputError(one_line(fmt::format("{} help: there is no command {}{}", program.get_name(),
                                            name, near ? "; did you mean " + *near + "?" : "")));
    before += (before.empty() ? "" : " ") + command->get_name();
    command = found;
  }
  const std::string name = before + (before.empty() ? "" : " ") + command->get_name();
  return program.get_formatter()->make_help(command, name, CLI::AppFormatMode::Normal);
}

} // namespace

CommandRun add_help(CLI::App& app) {
  const auto names = std::make_shared<std::vector<std::string>>();
  app.add_option("command", *names, "Command to tell about; default: all of them")
      ->option_text("COMMAND");
  app.footer(R"(Examples:
  vdbeam help
  vdbeam help render
  vdbeam help farm slurm)");
  return [&app, names] {
    print_output(help_of(*app.get_parent(), *names));
    return 0;
  };
}

} // namespace vdbeam::cli
