#include "scene/toml_value.h"

#include "text/text.h"
#include "vdbeam/error.h"

#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

constexpr char override_mark = '\x01'; // cannot begin a file's name that a user meant

constexpr std::size_t longest_value = 200; ///< bytes of a value in a message

std::optional<double> number_of(const toml::node& node) {
  if (const auto* whole = node.as_integer())
    return static_cast<double>(whole->get());
  if (const auto* number = node.as_floating_point())
    return number->get();
  return std::nullopt;
}

/// A whole number, also when written like 1e6.
std::optional<std::int64_t> whole_number_of(const toml::node& node) {
  if (const auto* whole = node.as_integer())
    return whole->get();
  const auto* number = node.as_floating_point();
  constexpr double exact = 9007199254740992.0; // 2^53
  if (number && std::abs(number->get()) <= exact && std::trunc(number->get()) == number->get())
    return static_cast<std::int64_t>(number->get());
  return std::nullopt;
}

std::optional<std::vector<double>> list_of(const SceneKey& key, const toml::node& node) {
  if (const auto single = number_of(node); single && key.one_for_all)
    return std::vector<double>(3, *single);
  const auto* array = node.as_array();
  const std::size_t expected = key.kind == KeyKind::matrix ? 12 : 3;
  if (!array || array->size() != expected)
    return std::nullopt;
  std::vector<double> list;
  for (const toml::node& item : *array) {
    const auto number = number_of(item);
    if (!number)
      return std::nullopt;
    list.push_back(*number);
  }
  return list;
}

/// Suggestion for a value of the wrong type: "; did you mean [0, 0, 5]?".
std::string remedy(const SceneKey& key, const toml::node& node) {
  const auto* text = node.as_string();
  if (!text)
    return {};
  if (key.kind == KeyKind::duration)
    return duration_remedy(text->get());
  const bool wants_list =
      key.kind == KeyKind::vector || key.kind == KeyKind::color || key.kind == KeyKind::matrix;
  const std::string list = wants_list ? bracketed_numbers(text->get()) : "";
  if (!list.empty())
    return "; did you mean " + list + "?";
  if (const std::string word = lower_case(text->get());
      key.kind == KeyKind::boolean && (word == "true" || word == "false"))
    return "; did you mean " + word + "?";
  return {};
}

/// The value, or nothing where the node's type does not fit the key.
std::optional<KeyValue> convert(const SceneKey& key, const toml::node& node) {
  const auto* text = node.as_string();
  if (text && !key.absent_word.empty() && text->get() == key.absent_word)
    return KeyValue{};
  const auto wrap = [](const auto& value) -> std::optional<KeyValue> {
    return value ? std::optional<KeyValue>(*value) : std::nullopt;
  };
  switch (key.kind) {
  case KeyKind::boolean:
    return node.is_boolean() ? std::optional<KeyValue>(std::int64_t{node.as_boolean()->get()})
                             : std::nullopt;
  case KeyKind::integer:
    return wrap(whole_number_of(node));
  case KeyKind::number:
    return wrap(number_of(node));
  case KeyKind::duration:
    return wrap(text ? parse_duration(text->get()) : number_of(node));
  case KeyKind::text:
  case KeyKind::file:
  case KeyKind::choice:
    return text ? std::optional<KeyValue>(text->get()) : std::nullopt;
  case KeyKind::vector:
  case KeyKind::color:
  case KeyKind::matrix:
    return wrap(list_of(key, node));
  }
  return std::nullopt;
}

} // namespace

std::string override_source(const std::string& origin) {
  return override_mark + origin;
}

bool is_override(const toml::node& node) {
  const auto& path = node.source().path;
  return path && !path->empty() && path->front() == override_mark;
}

std::string location_of(const toml::node& node) {
  const auto& path = node.source().path;
  if (!path) { // made on the way to a value of the command line
    if (const auto* table = node.as_table(); table && !table->empty())
      return location_of(table->begin()->second);
    if (const auto* list = node.as_array(); list && !list->empty())
      return location_of(*list->begin());
    return "scene";
  }
  if (is_override(node))
    return shortened(one_line(path->substr(1)), longest_value);
  return fmt::format("{}:{}", *path, node.source().begin.line);
}

std::string node_text(const toml::node& node) {
  if (const auto* text = node.as_string())
    return shortened(one_line("\"" + text->get() + "\""), longest_value);
  if (const auto* whole = node.as_integer())
    return fmt::format("{}", whole->get());
  if (const auto* number = node.as_floating_point())
    return fmt::format("{}", number->get());
  if (const auto* flag = node.as_boolean())
    return flag->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    std::string text;
    for (const toml::node& item : *array) {
      text += (text.empty() ? "" : ", ") + node_text(item);
      if (text.size() > 100)
        break;
    }
    return shortened(one_line("[" + text + "]"), longest_value);
  }
  return node.is_table() ? "a table" : "a date or time";
}

KeyValue read_key_value(const SceneKey& key, const std::string& path, const toml::node& node) {
  const auto value = convert(key, node);
  if (!value) {
    const std::string absent =
        key.absent_word.empty() ? "" : fmt::format(" or \"{}\"", key.absent_word);
    throw InputError(fmt::format("{}: {} must be {}{}, got {}{}", location_of(node), path,
                                 key.kind_text(), absent, node_text(node), remedy(key, node)));
  }
  if (const auto complaint = key.complaint(*value))
    throw InputError(one_line(fmt::format("{}: {} {}", location_of(node), path, *complaint)));
  return *value;
}

} // namespace vdbeam
