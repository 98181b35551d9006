#include "scene/toml_remedy.h"

#include "text/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <regex>
#include <sstream>
#include <vector>

namespace vdbeam {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

/// Where the key of this line was set before in the same table; 0 where that is not to be found.
std::size_t first_line_of(const std::string& name, const std::vector<std::string>& lines,
                          std::size_t line) {
  for (std::size_t i = std::min(line - 1, lines.size()); i-- > 0;) {
    const std::size_t begin = lines[i].find_first_not_of(" \t");
    if (begin == std::string::npos)
      continue;
    if (lines[i][begin] == '[')
      return 0;
    const std::size_t end = lines[i].find_first_of(" \t=", begin);
    if (lines[i].substr(begin, end - begin) == name)
      return i + 1;
  }
  return 0;
}

/// The name in single quotes of a reason.
std::string quoted_name(const std::string& reason) {
  const std::size_t begin = reason.find('\'');
  const std::size_t end = reason.find('\'', begin + 1);
  return end == std::string::npos ? "" : reason.substr(begin + 1, end - begin - 1);
}

/// The tables that a scene may have several of.
bool is_list_table(const std::string& name) {
  return name == "volume" || name == "instance" || name == "mesh" || name == "light" ||
         name == "layer";
}

/// The text between the = of a line and its comment or end, trimmed.
std::string value_of(const std::string& line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos)
    return {};
  std::string value = line.substr(equals + 1, line.find('#', equals) - equals - 1);
  value.erase(0, value.find_first_not_of(" \t"));
  value.erase(value.find_last_not_of(" \t\r") + 1);
  return value;
}

} // namespace

std::string toml_remedy(const std::string& reason, const std::string& text, std::size_t line) {
  const std::vector<std::string> lines = lines_of(text);
  const std::string here =
      line >= 1 && line <= lines.size() && lines[line - 1].size() < 1000 ? lines[line - 1] : "";
  if (reason.starts_with("cannot redefine existing array") && reason.ends_with("as table"))
    return fmt::format("; write [[{}]], in double brackets", quoted_name(reason));
  if (const std::string name = quoted_name(reason);
      reason.starts_with("cannot redefine existing table") && is_list_table(name))
    return fmt::format("; write [[{}]], in double brackets, for each of them", name);
  if (reason.starts_with("cannot redefine existing"))
    if (const std::size_t first = first_line_of(quoted_name(reason), lines, line); first > 0)
      return fmt::format("; it is there already, in line {}", first);
  if (reason.starts_with("unknown escape sequence"))
    return "; write a path with / or in single quotes: 'C:\\shot\\cloud.vdb'";
  if (std::smatch number; std::regex_search(here, number, std::regex(R"(=\s*(\d+),(\d+)\s*(#|$))")))
    return fmt::format("; decimals have a point: {}.{}", number[1].str(), number[2].str());
  const std::string value = value_of(here);
  if (const std::string list = bracketed_numbers(value); !list.empty())
    return fmt::format("; a list needs brackets: {}", list);
  if (const std::string word = lower_case(value); word == "true" || word == "false")
    return fmt::format("; write {}, in small letters", word);
  if (reason.starts_with("could not determine value type"))
    return "; a text needs quotes: \"...\"";
  return {};
}

} // namespace vdbeam
