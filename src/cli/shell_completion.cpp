#include "cli/help_format.h"
#include "cli/manual.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>
#include <sstream>

namespace vdbeam::cli {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames())
    names.push_back("-" + name);
  for (const std::string& name : option.get_lnames())
    names.push_back("--" + name);
  return names;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : between) + word;
  return text;
}

/// "continue stop" for an option that takes one of several words. What it takes is written in small
/// letters, a placeholder like T|N in capitals.
std::string choices_of(const CLI::Option& option) {
  std::string words = option.get_option_text();
  const bool is_list = words.find('|') != std::string::npos &&
                       words.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
  std::replace(words.begin(), words.end(), '|', ' ');
  return is_list ? words : "";
}

bool takes_value(const CLI::Option& option) {
  return !option.get_option_text().empty(); // flags have none
}

std::vector<const CLI::Option*> typed_options(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

/// Calls `visit(command, "farm slurm")` for the program and each of its commands.
void for_each_command(const CLI::App& command, const std::string& name,
                      const std::function<void(const CLI::App&, const std::string&)>& visit) {
  visit(command, name);
  for (const CLI::App* sub : visible_commands(command))
    for_each_command(*sub, name + (name.empty() ? "" : " ") + sub->get_name(), visit);
}

/// In single quotes for a shell; zsh also wants the brackets of a description escaped.
std::string quoted(const std::string& text, bool in_brackets = false) {
  std::string result;
  for (const char c : text)
    result += c == '\''                               ? std::string("'\\''")
              : in_brackets && (c == '[' || c == ']') ? std::string("\\") + c
                                                      : std::string(1, c);
  return result;
}

/// One option as zsh's _arguments takes it.
std::string zsh_option(const CLI::Option& option) {
  const std::vector<std::string> names = names_of(option);
  const std::string name = names.size() == 1 ? names.front() : "'{" + joined(names, ",") + "}'";
  std::string text = fmt::format("'{}[{}]", name, quoted(option.get_description(), true));
  if (const std::string choices = choices_of(option); !choices.empty())
    text += ":word:(" + choices + ")";
  else if (takes_value(option))
    text += ":value:_files";
  return text + "'";
}

std::string zsh_function(const CLI::App& command, const std::string& name) {
  std::string text = name + "() {\n  local curcontext=$curcontext state line\n  _arguments -C";
  for (const CLI::Option* option : typed_options(command))
    text += " \\\n    " + zsh_option(*option);
  const auto subs = visible_commands(command);
  if (subs.empty())
    return text + " \\\n    '*:file:_files'\n}\n";
  text += " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n"
          "  command)\n    local -a commands=(";
  for (const CLI::App* sub : subs)
    text += fmt::format("\n      '{}:{}'", sub->get_name(), quoted(sub->get_description()));
  text += ")\n    _describe command commands ;;\n  argument)\n    case $line[1] in\n";
  for (const CLI::App* sub : subs)
    text += fmt::format("    {0}) {1}_{0} ;;\n", sub->get_name(), name);
  text += "    esac ;;\n  esac\n}\n";
  for (const CLI::App* sub : subs)
    text += zsh_function(*sub, name + "_" + sub->get_name());
  return text;
}

} // namespace

std::string bash_completion(const CLI::App& program) {
  std::string path, values, words;
  for_each_command(program, "", [&](const CLI::App& command, const std::string& name) {
    if (!name.empty()) {
      const std::size_t space = name.rfind(' ');
      path += fmt::format("    \"{}:{}\") command=\"{}\" ;;\n",
                          space == name.npos ? "" : name.substr(0, space),
                          space == name.npos ? name : name.substr(space + 1), name);
    }
    std::vector<std::string> options, commands;
    for (const CLI::Option* option : typed_options(command)) {
      const std::vector<std::string> names = names_of(*option);
      options.insert(options.end(), names.begin(), names.end());
      if (takes_value(*option))
        for (const std::string& typed : names)
          values += fmt::format("  \"{}:{}\") words=\"{}\" value=1 ;;\n", name, typed,
                                choices_of(*option));
    }
    for (const CLI::App* sub : visible_commands(command))
      commands.push_back(sub->get_name());
    words += fmt::format("  \"{}\") options=\"{}\" commands=\"{}\" ;;\n", name,
                         joined(options, " "), joined(commands, " "));
  });
  return fmt::format(R"(# bash completion for vdbeam, written by "vdbeam generate bash"
_vdbeam() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}}
  local command="" options="" commands="" words="" value="" i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command:${{COMP_WORDS[i]}}" in
{}    esac
  done
  case "$command:$previous" in
{}  esac
  case "$command" in
{}  esac
  # Where nothing fits, bash completes the names of files.
  if [[ $value ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  elif [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$commands" -- "$current"))
  fi
}}
complete -o bashdefault -o default -F _vdbeam vdbeam
)",
                     path, values, words);
}

std::string zsh_completion(const CLI::App& program) {
  return "#compdef vdbeam\n# zsh completion for vdbeam, written by \"vdbeam generate zsh\"\n" +
         zsh_function(program, "_vdbeam") + "_vdbeam \"$@\"\n";
}

} // namespace vdbeam::cli
