#include "cli/commands.h"
#include "cli/manual.h"
#include "console/streams.h"
#include "keys/scene_keys.h"
#include "report/versions.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {
namespace {

/// The tables of docs/reference/scene.md, each after its name; tools/make_reference.py reads them.
std::string key_tables_markdown() {
  std::string text;
  for (const SceneSection section : scene_sections())
    text += section_name(section) + "\n" + key_table_markdown(section) + "\n";
  return text;
}

} // namespace

/// Writes files made from the program's own tables: the manual page and completions that packages
/// install, and tables of the documentation. Not shown by --help.
CommandRun add_generate(CLI::App& app) {
  const auto kind = std::make_shared<std::string>();
  app.group("");
  app.add_option("kind", *kind, "What to write")
      ->required()
      ->check(CLI::IsMember({"man", "bash", "zsh", "keys"}))
      ->option_text("man|bash|zsh|keys");
  return [&app, kind] {
    const CLI::App& program = *app.get_parent();
    const auto versions = component_versions();
    const std::string version = versions.front().first + " " + versions.front().second;
    print_output(*kind == "man"    ? manual_page(program, version)
                 : *kind == "bash" ? bash_completion(program)
                 : *kind == "zsh"  ? zsh_completion(program)
                                   : key_tables_markdown());
    return 0;
  };
}

} // namespace vdbeam::cli
