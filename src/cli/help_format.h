#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace vdbeam::cli {

/// Lays out --help: lines of at most 80 columns, options in their groups, the general ones last.
class HelpFormatter : public CLI::Formatter {
public:
  HelpFormatter();

  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_usage(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* sub) const override;
};

/// "--on-error continue|stop", "-f,--frames RANGE", "SCENE|VDB": an option as help shows it.
std::string option_usage(const CLI::Option& option);

/// Puts options of an app under one heading of its help.
void group_options(CLI::App& app, const std::string& group,
                   std::initializer_list<const char*> options);

/// An app's commands that help shows.
std::vector<const CLI::App*> visible_commands(const CLI::App& app);

/// An app's groups of options, in the order of help.
std::vector<std::string> option_groups(const CLI::App& app);

} // namespace vdbeam::cli
