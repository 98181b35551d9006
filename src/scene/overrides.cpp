#include "scene/overrides.h"

#include "scene/toml_nesting.h"
#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <sstream>

namespace vdbeam {
namespace {

[[noreturn]] void fail(const Override& entry, const std::string& text) {
  throw InputError(one_line(fmt::format("{}: {}", entry.origin, text)));
}

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');)
    parts.push_back(part);
  return parts;
}

std::optional<std::size_t> parse_index(const std::string& text) {
  std::size_t index = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, index);
  return error == std::errc{} && stop == end ? std::optional(index) : std::nullopt;
}

/// The value as a one-entry table whose nodes remember the option. Text that is not TOML is a
/// string: nobody quotes twice in a shell.
toml::table parse_value(const Override& entry) {
  const std::string source = override_source(entry.origin);
  check_nesting(entry.value, "the value of " + entry.key);
  try {
    toml::table table = toml::parse("v = " + entry.value, source);
    if (table.size() == 1)
      return table;
  } catch (const toml::parse_error&) {
    const bool bare = entry.value.find_first_of("[]{}\"'\n\r") == std::string::npos;
    if (!bare)
      fail(entry, fmt::format("the value of {} is not valid TOML", entry.key));
  }
  try {
    return toml::parse("v = '" + entry.value + "'", source);
  } catch (const toml::parse_error&) {
    fail(entry, fmt::format("the value of {} is not valid TOML", entry.key));
  }
}

/// The element `name` of a list, made at its end where it is the next one. A list of one needs no
/// number; then `used` is false.
toml::node& list_element(toml::array& list, const std::string& name, const std::string& path,
                         const Override& entry, bool& used) {
  const auto index = parse_index(name);
  used = index.has_value();
  if (index && *index == list.size())
    list.push_back(toml::table{});
  if (index && *index < list.size())
    return list[*index];
  if (!index && list.size() == 1)
    return list[0];
  if (list.empty())
    fail(entry, fmt::format("there is no {0} yet; write {0}.0 for the first", path));
  fail(entry, fmt::format("say which {0}: {0}.0{1}", path,
                          list.size() > 1 ? fmt::format(" to {}.{}", path, list.size() - 1) : ""));
}

/// `phase = "mie"` becomes `phase = { type = "mie" }`, so that its keys can be set.
void expand_shorthand(toml::table& table, const std::string& name) {
  if ((name != "phase" && name != "material") || !table[name].is_string())
    return;
  toml::table expanded;
  expanded.insert("type", *table[name].as_string());
  table.insert_or_assign(name, std::move(expanded));
}

/// The node that holds the last part of the path.
toml::node& find_parent(toml::table& root, const std::vector<std::string>& parts,
                        const Override& entry) {
  toml::node* node = &root;
  std::string path;
  for (std::size_t i = 0; i + 1 < parts.size();) {
    bool used = true;
    if (auto* table = node->as_table()) {
      const bool is_list =
          i == 0 && (parts[0] == "volume" || parts[0] == "instance" || parts[0] == "mesh" ||
                     parts[0] == "light" || parts[0] == "layer");
      expand_shorthand(*table, parts[i]);
      if (!table->contains(parts[i])) {
        const std::string child = path + (path.empty() ? "" : ".") + parts[i];
        if (!is_list && parse_index(parts[i + 1]))
          fail(entry, fmt::format("the scene has no {0}; set all of it: {0}=[...]", child));
        if (is_list)
          table->insert(parts[i], toml::array{});
        else
          table->insert(parts[i], toml::table{});
      }
      node = table->get(parts[i]);
    } else if (auto* list = node->as_array()) {
      node = &list_element(*list, parts[i], path, entry, used);
    } else {
      fail(entry, fmt::format("{} is a single value", path));
    }
    if (used)
      path += (path.empty() ? "" : ".") + parts[i++];
  }
  bool used = true;
  if (auto* list = node->as_array(); list && !parse_index(parts.back()))
    node = &list_element(*list, parts.back(), path, entry, used);
  return *node;
}

} // namespace

Override parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto strip = [](std::string part) {
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    return part;
  };
  Override entry{strip(text.substr(0, equals)), "", "--set " + text};
  if (equals == std::string::npos || entry.key.empty())
    fail(entry, "must look like key.path=value, e.g. volume.0.extinction=80");
  entry.value = strip(text.substr(equals + 1));
  if (entry.value.empty())
    fail(entry, "the value is missing");
  return entry;
}

void apply_override(toml::table& root, const Override& entry) {
  const std::vector<std::string> parts = split_path(entry.key);
  for (const std::string& part : parts)
    if (part.empty())
      fail(entry, "must look like key.path=value, e.g. volume.0.extinction=80");
  if (parts.size() > most_dotted_names)
    fail(entry, "has more names between dots than any key of a scene");
  toml::table values = parse_value(entry);
  toml::node& parent = find_parent(root, parts, entry);
  const std::string& name = parts.back();
  values.get("v")->visit([&](auto& value) {
    if (auto* table = parent.as_table()) {
      table->insert_or_assign(name, std::move(value));
      return;
    }
    auto* list = parent.as_array();
    const auto index = parse_index(name);
    if (list && index && *index == list->size())
      return list->push_back(std::move(value));
    if (!list || !index || *index > list->size())
      fail(entry, fmt::format("there is no {}", entry.key));
    list->insert(list->erase(list->begin() + static_cast<std::ptrdiff_t>(*index)),
                 std::move(value));
  });
}

} // namespace vdbeam
