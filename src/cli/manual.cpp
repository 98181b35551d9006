#include "cli/manual.h"

#include "cli/help_format.h"
#include "keys/scene_keys.h"

#include <fmt/format.h>
#include <sstream>

namespace vdbeam::cli {
namespace {

/// Text as roff prints it unchanged: no command, no hyphen for a minus.
std::string escaped(const std::string& text) {
  std::string result;
  bool line_start = true;
  for (const char c : text) {
    if (line_start && (c == '.' || c == '\''))
      result += "\\&";
    result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    line_start = c == '\n';
  }
  return result;
}

std::string preformatted(const std::string& text) {
  return ".nf\n" + escaped(text) + (text.ends_with('\n') ? "" : "\n") + ".fi\n";
}

std::string option_entry(const CLI::Option& option) {
  return fmt::format(".TP\n.B {}\n{}\n", escaped(option_usage(option)),
                     escaped(option.get_description()));
}

/// A command with its options and examples, then its own commands.
std::string command_section(const CLI::App& command, const std::string& name) {
  std::string text =
      fmt::format(".SS {}\n{}.\n", escaped(name), escaped(command.get_description()));
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional())
      text += option_entry(*option);
  for (const std::string& group : option_groups(command))
    for (const CLI::Option* option : command.get_options())
      if (!option->get_positional() && option->get_group() == group &&
          option != command.get_help_ptr())
        text += option_entry(*option);
  if (!command.get_footer().empty())
    text += ".PP\n" + preformatted(command.get_footer());
  for (const CLI::App* sub : visible_commands(command))
    text += command_section(*sub, name + " " + sub->get_name());
  return text;
}

} // namespace

std::string manual_page(const CLI::App& program, const std::string& version) {
  std::string text =
      fmt::format(".TH VDBEAM 1 \"\" \"{}\" \"User Commands\"\n"
                  ".SH NAME\nvdbeam \\- render clouds, smoke and fire of OpenVDB files\n"
                  ".SH SYNOPSIS\n.B vdbeam\n.I COMMAND\n[\\fIOPTIONS\\fR]\n"
                  ".SH DESCRIPTION\n{}.\n",
                  version, escaped(program.get_description()));
  text += ".PP\n" + preformatted(program.get_footer());
  text += ".SH OPTIONS\n";
  for (const CLI::Option* option : program.get_options())
    text += option_entry(*option);
  text += ".SH COMMANDS\n";
  for (const CLI::App* command : visible_commands(program))
    text += command_section(*command, program.get_name() + " " + command->get_name());
  text += ".SH SCENE FILES\nA scene file is TOML with these tables and keys.\n.PP\n";
  return text + preformatted(key_tables_text(80)) +
         ".SH SEE ALSO\nThe folder of vdbeam's documentation, e.g. /usr/share/doc/vdbeam, has the "
         "whole documentation and sample scenes.\n";
}

} // namespace vdbeam::cli
