#include "cli/commands.h"
#include "console/streams.h"
#include "console/terminal.h"
#include "keys/scene_keys.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

/// "volume.phase" and "phase" are names of one table.
std::string last_name(SceneSection section) {
  const std::string name = section_name(section);
  return name.substr(name.find('.') + 1);
}

/// A table of a scene file by its name, or all of them where it is empty.
std::string help_of_table(const std::string& program, const std::string& name) {
  if (name.empty())
    return key_tables_text(text_columns());
  std::vector<std::string> known;
  for (const SceneSection section : scene_sections()) {
    if (name == section_name(section) || name == last_name(section))
      return key_table_text(section, text_columns());
    known.push_back(last_name(section));
  }
  const auto near = nearest_word(name, known);
  throw InputError(one_line(fmt::format("{} help scene: there is no table {}{}", program, name,
                                        near ? "; did you mean " + *near + "?"
                                             : "; the tables are " + join_words(known, "and"))));
}

bool is_table(const std::string& name) {
  for (const SceneSection section : scene_sections())
    if (name == section_name(section) || name == last_name(section))
      return true;
  return false;
}

bool has_command(const CLI::App& program, const std::string& name) {
  const auto found =
      program.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; });
  return !found.empty();
}

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
    if (!found && command == &program)
      for (const SceneSection section : scene_sections())
        known.push_back(last_name(section));
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
  app.add_option("command", *names,
                 "Command or table of a scene file to describe; default: all commands")
      ->option_text("COMMAND|TABLE");
  app.footer(R"(Examples:
  vdbeam help
  vdbeam help render
  vdbeam help farm slurm
  vdbeam help light                             the keys of [[light]]
  vdbeam help scene                             the keys of all tables of a scene file
  vdbeam help scene render                      those of [render])");
  return [&app, names] {
    const CLI::App& program = *app.get_parent();
    const bool scene = !names->empty() && names->front() == "scene";
    // A command has the name first: "render" is one, and a table.
    const bool table =
        names->size() == 1 && is_table(names->front()) && !has_command(program, names->front());
    print_output(scene   ? help_of_table(program.get_name(), names->size() > 1 ? (*names)[1] : "")
                 : table ? help_of_table(program.get_name(), names->front())
                         : help_of(program, *names));
    return 0;
  };
}

} // namespace vdbeam::cli
