#include "cli/usage_error.h"

#include "cli/help_format.h"
#include "cli/scene_options.h"
#include "keys/key_synonyms.h"
#include "scene/scene_document.h"
#include "text/frame_range.h"
#include "text/text.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <set>
#include <sstream>

namespace vdbeam::cli {
namespace {

bool is_option(const std::string& word) {
  return word.size() > 1 && word.front() == '-';
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : visible_commands(app))
    names.push_back(sub->get_name());
  return names;
}

/// The options of a command as they are typed, each with its dashes.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      names.push_back("--" + name);
    for (const std::string& name : option->get_snames())
      names.push_back("-" + name);
  }
  return names;
}

/// How far the words follow the commands: the command that they end at.
struct Place {
  const CLI::App* command;
  std::string name;     ///< "vdbeam farm slurm"
  std::string unknown;  ///< the word that should be a command of `command`, if any
  std::size_t next = 0; ///< the first word after the commands
};

Place find_command(const CLI::App& program, const std::vector<std::string>& words) {
  Place place{&program, program.get_name(), {}, 0};
  for (; place.next < words.size() && !command_names(*place.command).empty(); ++place.next) {
    const std::string& word = words[place.next];
    if (is_option(word))
      continue;
    const auto found = place.command->get_subcommands(
        [&](const CLI::App* sub) { return sub->get_name() == word; });
    if (found.empty()) {
      place.unknown = word;
      break;
    }
    place.command = found.front();
    place.name += " " + word;
  }
  return place;
}

bool looks_like_a_scene(const std::string& word) {
  std::error_code ignored;
  return is_vdb_file(word) || std::filesystem::path(word).extension() == ".toml" ||
         std::filesystem::is_regular_file(word, ignored);
}

std::string unknown_command(const Place& place) {
  const std::vector<std::string> names = command_names(*place.command);
  if (place.command->get_parent() == nullptr && looks_like_a_scene(place.unknown))
    return fmt::format("{0}: {1} is not a command; to render it: {0} render {1}", place.name,
                       place.unknown);
  const auto near = nearest_word(place.unknown, names);
  return fmt::format("{}: {} is not one of its commands, which are {}{}", place.name, place.unknown,
                     join_words(names, "and"),
                     near ? fmt::format("; did you mean {}?", *near) : "");
}

/// "smoke/smoke.####.vdb -f 1-24" for the files of one sequence; empty for any others.
std::string sequence_of(const std::vector<std::string>& files) {
  if (files.size() < 2)
    return {};
  const std::string pattern = frame_pattern_of(files.front());
  if (pattern.empty())
    return {};
  for (const std::string& file : files)
    if (frame_pattern_of(file) != pattern)
      return {};
  return fmt::format("{} -f {}", pattern, format_frame_range(frames_on_disk(pattern)));
}

/// Option for a key that an unknown option sets in other programs ("--samples"); empty if it
/// means none, and for commands that take no scene.
std::string option_meant_by(const std::string& option, const CLI::App& command) {
  if (!command.get_option_no_throw("--set"))
    return {};
  std::string word = option.substr(option.find_first_not_of('-'));
  std::replace(word.begin(), word.end(), '-', '_');
  const std::string key = key_meant_by(word);
  return key.empty() ? "" : option_for_key(key);
}

/// The option for a key of the scene that was written like an option ("--fov"); empty for any
/// other.
std::string option_of_key(const std::string& option, const CLI::App& command) {
  if (!command.get_option_no_throw("--set"))
    return {};
  std::string word = option.substr(option.find_first_not_of('-'));
  std::replace(word.begin(), word.end(), '-', '_');
  for (const SceneSection section :
       {SceneSection::render, SceneSection::image, SceneSection::camera})
    if (find_key(section, word))
      return option_for_key(section_name(section) + "." + word);
  return {};
}

bool is_plain_number(const std::string& word) {
  return word.find_first_not_of("+-0123456789.") == std::string::npos &&
         word.find_first_of("0123456789") != std::string::npos;
}

/// A value of several numbers that was written with spaces: "--region 10 10 20 20". Empty where
/// there is none.
std::string spread_value(const Place& place, const std::vector<std::string>& words) {
  for (std::size_t i = 0; i + 2 < words.size(); ++i) {
    const CLI::Option* option =
        is_option(words[i]) ? place.command->get_option_no_throw(words[i]) : nullptr;
    if (!option)
      continue;
    const std::size_t equals = words[i] == "--set" ? words[i + 1].find('=') : std::string::npos;
    const bool sets = equals != std::string::npos;
    const bool size = option->get_option_text() == "WxH";
    if (!sets && !size && option->get_option_text().find(',') == std::string::npos)
      continue;
    std::string first = words[i + 1].substr(sets ? equals + 1 : 0);
    if (first.ends_with(','))
      first.pop_back();
    if (!is_plain_number(first))
      continue;
    std::string value = first;
    std::size_t count = 1;
    for (std::size_t j = i + 2; j < words.size(); ++j, ++count) {
      const std::string word =
          words[j].ends_with(',') ? words[j].substr(0, words[j].size() - 1) : words[j];
      if (!is_plain_number(word))
        break;
      value += (size ? "x" : ",") + word;
    }
    if (count < 2)
      continue;
    return fmt::format("{}: the value of {} is one word: {} {}", place.name, words[i], words[i],
                       sets ? words[i + 1].substr(0, equals + 1) + "[" + value + "]" : value);
  }
  return {};
}

/// Error for an unknown option, or one file too many.
std::string surplus_words(const Place& place, const std::vector<std::string>& words,
                          const std::vector<std::string>& surplus) {
  const auto option = std::find_if(surplus.begin(), surplus.end(), is_option);
  if (option != surplus.end()) {
    const std::string name = option->substr(0, option->find('='));
    std::string meant = option_meant_by(name, *place.command);
    // A single letter is close to every other.
    if (const auto near = nearest_word(name, option_names(*place.command));
        near && name.size() > 2 && meant.empty())
      meant = *near;
    if (meant.empty())
      meant = option_of_key(name, *place.command);
    return fmt::format("{}: there is no option {}{}", place.name, name,
                       meant.empty() ? fmt::format("; {} --help lists them all", place.name)
                                     : fmt::format("; did you mean {}?", meant));
  }
  if (const std::string spread = spread_value(place, words); !spread.empty())
    return spread;
  const auto is_volume = [](const std::string& word) {
    return !is_option(word) && is_vdb_file(word);
  };
  std::vector<std::string> volumes;
  std::copy_if(words.begin(), words.end(), std::back_inserter(volumes), is_volume);
  if (const std::string sequence = sequence_of(volumes); !sequence.empty())
    return fmt::format("{}: takes one scene, got {} files; for a sequence write {}", place.name,
                       volumes.size(), sequence);
  return fmt::format(
      "{}: cannot use \"{}\"{}; {} --help shows what it takes", place.name, surplus.front(),
      surplus.size() > 1 ? fmt::format(" and {} more", count_text(surplus.size() - 1, "word")) : "",
      place.name);
}

/// The first thing that must be given and is not; empty where nothing is missing.
std::string missing_word(const Place& place) {
  for (const CLI::Option* option : place.command->get_options())
    if (option->get_required() && option->count() == 0)
      return fmt::format("{}: {} is missing: {}", place.name,
                         option->get_positional() ? option->get_option_text()
                                                  : option->get_name(false, true),
                         option->get_description());
  return {};
}

/// A value that is missing or that its option does not take. CLI11's text names the option; what it
/// could be is described as in the help.
std::string value_error(const CLI::App& command, const CLI::ParseError& error) {
  const std::string text = error.what();
  const CLI::Option* option = nullptr;
  for (const CLI::Option* candidate : command.get_options()) {
    const std::string name = candidate->get_name();
    if (text.starts_with(name + ":") || text.find(" " + name + " ") != std::string::npos)
      option = candidate;
  }
  if (!option)
    return text;
  const std::string usage = option_usage(*option);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) && option->count() > 1)
    return fmt::format("{} may be given once only: {}", option->get_name(), usage);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
    return fmt::format("{} needs a value: {}", option->get_name(), usage);
  const std::string value = option->results().empty() ? "" : option->results().front();
  if (dynamic_cast<const CLI::ConversionError*>(&error))
    return fmt::format("{} {}: must be a number", option->get_name(), value);
  std::vector<std::string> choices;
  std::stringstream stream(option->get_option_text());
  for (std::string choice; std::getline(stream, choice, '|');)
    choices.push_back(choice);
  if (choices.size() < 2)
    return text;
  const auto near = nearest_word(value, choices);
  return fmt::format("{} {}: must be {}{}", option->get_name(), value, join_words(choices, "or"),
                     near ? "; did you mean " + *near + "?" : "");
}

} // namespace

std::string usage_error(const CLI::App& program, const std::vector<std::string>& words,
                        const CLI::ParseError& error) {
  const Place place = find_command(program, words);
  if (!place.unknown.empty())
    return one_line(unknown_command(place));
  std::vector<std::string> unused = program.remaining(true);
  const std::set<std::string> set(unused.begin(), unused.end());
  std::vector<std::string> surplus; // in the order of the command line
  std::copy_if(words.begin(), words.end(), std::back_inserter(surplus),
               [&](const std::string& word) { return set.contains(word); });
  if (std::any_of(surplus.begin(), surplus.end(), is_option))
    return one_line(surplus_words(place, words, surplus));
  if (const auto names = command_names(*place.command); !names.empty())
    return fmt::format("{0}: which command? {1}; {0} --help describes them", place.name,
                       join_words(names, "or"));
  if (dynamic_cast<const CLI::RequiredError*>(&error))
    if (const std::string text = missing_word(place); !text.empty())
      return text;
  if (!surplus.empty())
    return one_line(surplus_words(place, words, surplus));
  return one_line(fmt::format("{}: {}", place.name, value_error(*place.command, error)));
}

} // namespace vdbeam::cli
