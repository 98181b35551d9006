#include "cli/commands.h"
#include "cli/manual.h"
#include "console/streams.h"
#include "report/versions.h"

#include <fmt/format.h>
#include <memory>

namespace vdbeam::cli {

/// Writes what a package installs beside the program; the build runs it. Not shown by --help.
CommandRun add_generate(CLI::App& app) {
  const auto kind = std::make_shared<std::string>();
  app.group("");
  app.add_option("kind", *kind, "What to write")
      ->required()
      ->check(CLI::IsMember({"man", "bash", "zsh"}))
      ->option_text("man|bash|zsh");
  return [&app, kind] {
    const CLI::App& program = *app.get_parent();
    const auto versions = component_versions();
    const std::string version = versions.front().first + " " + versions.front().second;
    print_output(*kind == "man"    ? manual_page(program, version)
                 : *kind == "bash" ? bash_completion(program)
                                   : zsh_completion(program));
    return 0;
  };
}

} // namespace vdbeam::cli
