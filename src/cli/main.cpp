#include "batch/failure.h"
#include "cli/commands.h"
#include "cli/help_format.h"
#include "cli/usage_error.h"
#include "console/events.h"
#include "console/streams.h"
#include "console/terminal.h"
#include "keys/scene_keys.h"
#include "report/versions.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <exception>
#include <fmt/format.h>
#include <sstream>

namespace {

using namespace vdbeam;

const char* const footer =
    R"(Examples:
  vdbeam render cloud.vdb                       a bare VDB is a scene
  vdbeam init cloud.vdb -o cloud.toml           a scene file to edit
  vdbeam render cloud.toml -o cloud.exr --time 60s --preview cloud.png
  vdbeam render smoke.toml -f 1-24 -o smoke.####.exr
  vdbeam help COMMAND                           options and examples of a command
  vdbeam help light                             the keys of one table of a scene file
  vdbeam --help-scene                           every key of a scene file

Exit codes:
  0    done
  1    a defect in vdbeam
  2    bad input: an option, a scene file or an image; one line says what and where
  3    a frame failed: unreadable volume, full disk, not enough memory
  130  interrupted (SIGINT), 143 terminated (SIGTERM), 129 hung up (SIGHUP): the passes so far
       are in a checkpoint; a second signal ends the program at once)";

std::string version_text() {
  std::string text;
  for (const auto& [name, version] : component_versions())
    text += fmt::format("{}{} {}", text.empty() ? "" : "\n", name, version);
  return text;
}

/// Whether the words ask for events. They are read before the command line is, so that its errors
/// are events too.
bool events_wanted(const std::vector<std::string>& words) {
  if (words.empty() || words.front() != "render")
    return false;
  for (std::size_t i = 1; i < words.size(); ++i)
    if (words[i] == "--progress=json" || (words[i - 1] == "--progress" && words[i] == "json"))
      return true;
  return false;
}

int fail(const std::string& line, ExitCode code) {
  cli::log_error(line);
  cli::send_error(line, static_cast<int>(code));
  return static_cast<int>(code);
}

/// Options and commands; exits by exception, as CLI11 does.
int run(int argc, char** argv) {
  CLI::App app(
      "vdbeam: clouds, smoke and fire from OpenVDB files, by photon mapping and path tracing",
      "vdbeam");
  app.footer(footer);
  app.require_subcommand(1);
  app.formatter(std::make_shared<cli::HelpFormatter>()); // the commands inherit it
  app.set_version_flag("-v,--version", version_text,
                       "Print the versions of vdbeam and its main libraries");
  app.set_help_flag("-h,--help", "Print this help");
  app.add_flag_callback(
      "--help-scene", [] { throw CLI::CallForVersion(key_tables_text(cli::text_columns()), 0); },
      "Print every key of a scene file with its unit, range and default");
  std::vector<cli::CommandRun> runs;
  std::vector<CLI::App*> subcommands;
  for (const cli::Command& command : cli::commands()) {
    subcommands.push_back(app.add_subcommand(command.name, command.description));
    subcommands.back()->group("Commands");
    runs.push_back(command.add(*subcommands.back()));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) { // --help, --version
    std::ostringstream text;
    const int code = app.exit(request, text, text);
    cli::print_output(text.str());
    return code;
  } catch (const CLI::ParseError& error) {
    return fail(cli::usage_error(app, {argv + 1, argv + argc}, error), ExitCode::bad_input);
  }
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (subcommands[i]->parsed())
      return runs[i]();
  return static_cast<int>(ExitCode::internal_error);
}

} // namespace

int main(int argc, char** argv) {
  cli::guard_standard_streams();
  if (events_wanted({argv + std::min(argc, 1), argv + argc}))
    cli::enable_events();
  int code = 0;
  try {
    code = run(argc, argv);
  } catch (const std::exception& error) {
    const cli::Failure failure = cli::describe(error);
    code = fail(failure.line, failure.code);
  }
  cli::send_end(code);
  return code;
}
