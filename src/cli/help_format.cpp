#include "cli/help_format.h"

#include "text/wrap.h"

#include <algorithm>

namespace vdbeam::cli {
namespace {

constexpr std::size_t line_width = 80, name_width = 26;
constexpr const char* general_group = "Options";

} // namespace

HelpFormatter::HelpFormatter() {
  label("Positionals", "Arguments");
  label("SUBCOMMAND", "COMMAND");
}

std::string option_usage(const CLI::Option& option) {
  if (option.get_positional())
    return option.get_option_text();
  const std::string text = option.get_option_text();
  return option.get_name(false, true) + (text.empty() ? "" : " " + text);
}

std::vector<const CLI::App*> visible_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

std::vector<std::string> option_groups(const CLI::App& app) {
  std::vector<std::string> groups = app.get_groups();
  std::stable_partition(groups.begin(), groups.end(),
                        [](const std::string& group) { return group != general_group; });
  return groups;
}

void group_options(CLI::App& app, const std::string& group,
                   std::initializer_list<const char*> options) {
  for (const char* option : options)
    app.get_option(option)->group(group);
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  std::string text =
      make_description(app) + make_usage(app, std::move(name)) + make_positionals(app);
  for (const std::string& group : option_groups(*app)) {
    const auto options = app->get_options([&](const CLI::Option* option) {
      return option->get_group() == group && option->nonpositional();
    });
    if (!group.empty() && !options.empty())
      text += make_group(group, false, options);
  }
  return text + make_subcommands(app, mode) + "\n" + make_footer(app);
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool /*is_positional*/) const {
  return two_columns(option_usage(*option), option->get_description(), name_width, line_width);
}

std::string HelpFormatter::make_option_usage(const CLI::Option* option) const {
  const std::string text = option->get_option_text();
  return option->get_required() ? text : "[" + text + "]";
}

std::string HelpFormatter::make_subcommand(const CLI::App* sub) const {
  return two_columns(sub->get_name(), sub->get_description(), name_width, line_width);
}

} // namespace vdbeam::cli
