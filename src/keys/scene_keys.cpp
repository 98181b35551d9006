#include "keys/scene_keys.h"

#include "keys/key_synonyms.h"
#include "text/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Whole-number keys hold at most what their C++ type holds; nobody wants to read that bound.
constexpr double unbounded = 2147483647;

bool has_upper(const NumberRange& range) {
  return range.upper < unbounded;
}
bool has_lower(const NumberRange& range) {
  return std::isfinite(range.lower);
}

std::string interval(const NumberRange& range) {
  return fmt::format("{}{}, {}{}", range.lower_open ? '(' : '[', range.lower, range.upper,
                     range.upper_open ? ')' : ']');
}

std::size_t list_length(KeyKind kind) {
  return kind == KeyKind::matrix ? 12 : 3;
}

std::string format_list(const std::vector<double>& list, KeyKind kind) {
  std::string text;
  for (const double x : list) {
    // Colours are stored in single precision: print what was written.
    const std::string number =
        kind == KeyKind::color ? fmt::format("{}", static_cast<float>(x)) : fmt::format("{}", x);
    text += (text.empty() ? "" : ", ") + number;
  }
  return "[" + text + "]";
}

} // namespace

bool NumberRange::contains(double x) const {
  return (lower_open ? x > lower : x >= lower) && (upper_open ? x < upper : x <= upper);
}

std::string NumberRange::requirement() const {
  if (has_upper(*this))
    return "must lie in " + interval(*this);
  if (has_lower(*this))
    return fmt::format("must be {} {}", lower_open ? "greater than" : "at least", lower);
  return {};
}

std::string NumberRange::text() const {
  if (has_upper(*this))
    return interval(*this);
  if (has_lower(*this))
    return fmt::format("{} {}", lower_open ? ">" : ">=", lower);
  return "any";
}

std::optional<std::string> SceneKey::complaint(const KeyValue& value) const {
  const auto got = [&] { return ", got " + format(value); };
  const auto number_complaint = [&](double x) -> std::optional<std::string> {
    if (!std::isfinite(x))
      return "must be finite" + got();
    if (range.contains(x))
      return std::nullopt;
    const bool too_large = x > range.upper && !has_upper(range);
    return (too_large ? fmt::format("must be at most {:.0f}", range.upper) : range.requirement()) +
           got();
  };
  if (const auto* list = std::get_if<std::vector<double>>(&value)) {
    if (list->size() != list_length(kind))
      return fmt::format("must be {}", kind_text()) + got();
    for (const double x : *list)
      if (auto text = number_complaint(x))
        return text;
  } else if (const auto* whole = std::get_if<std::int64_t>(&value)) {
    return number_complaint(static_cast<double>(*whole));
  } else if (const auto* number = std::get_if<double>(&value)) {
    return number_complaint(*number);
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    if (!choices.empty() && std::find(choices.begin(), choices.end(), *text) == choices.end()) {
      std::string remedy = value_remedy(section, name, *text);
      if (const auto near = nearest_word(*text, choices); near && remedy.empty())
        remedy = "; did you mean " + *near + "?";
      return fmt::format("must be {}{}{}", join_words(choices, "or"), got(), remedy);
    }
    if (required && text->empty())
      return "must not be empty";
  }
  return std::nullopt;
}

std::string SceneKey::format(const KeyValue& value) const {
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    return kind == KeyKind::boolean ? (*whole ? "true" : "false") : fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&value))
    return fmt::format("{}", *number);
  if (const auto* text = std::get_if<std::string>(&value))
    return fmt::format("\"{}\"", *text);
  if (const auto* list = std::get_if<std::vector<double>>(&value))
    return format_list(*list, kind);
  return fmt::format("\"{}\"", absent_word);
}

std::string SceneKey::default_text() const {
  if (required)
    return "required";
  if (!get)
    return name == "scale" ? "[1, 1, 1]" : "[0, 0, 0]";
  Scene scene;
  scene.volumes.emplace_back();
  scene.surfaces.emplace_back();
  scene.lights.emplace_back();
  scene.layers.emplace_back();
  scene.instances.emplace_back();
  const KeyValue value = get(scene, 0);
  if (std::holds_alternative<std::monostate>(value) && absent_word.empty())
    return "as render." + name;
  return format(value);
}

std::string SceneKey::kind_text() const {
  switch (kind) {
  case KeyKind::boolean:
    return "true or false";
  case KeyKind::integer:
    return "a whole number";
  case KeyKind::number:
    return "a number";
  case KeyKind::text:
    return "a text";
  case KeyKind::file:
    return "a path";
  case KeyKind::choice:
    return join_words(choices, "or");
  case KeyKind::vector:
    return one_for_all ? "3 numbers or one for all" : "3 numbers";
  case KeyKind::color:
    return "3 numbers (red, green, blue) or one for all";
  case KeyKind::duration:
    return R"(seconds or a text like "90s", "5m" or "1h30m")";
  case KeyKind::matrix:
    return "12 numbers";
  }
  return {};
}

const SceneKey* find_key(SceneSection section, const std::string& name) {
  for (const SceneKey& key : scene_keys())
    if (key.section == section && key.name == name)
      return &key;
  return nullptr;
}

std::vector<std::string> key_names(SceneSection section) {
  std::vector<std::string> names;
  for (const SceneKey& key : scene_keys())
    if (key.section == section)
      names.push_back(key.name);
  if (section == SceneSection::volume)
    names.insert(names.end(), {"phase", "emission", "time"});
  if (section == SceneSection::instance)
    names.emplace_back("rows");
  if (section == SceneSection::mesh)
    names.emplace_back("material");
  return names;
}

std::string section_name(SceneSection section) {
  switch (section) {
  case SceneSection::image:
    return "image";
  case SceneSection::camera:
    return "camera";
  case SceneSection::volume:
    return "volume";
  case SceneSection::phase:
    return "volume.phase";
  case SceneSection::emission:
    return "volume.emission";
  case SceneSection::instance:
    return "instance";
  case SceneSection::mesh:
    return "mesh";
  case SceneSection::material:
    return "mesh.material";
  case SceneSection::light:
    return "light";
  case SceneSection::layer:
    return "layer";
  case SceneSection::render:
    return "render";
  }
  return {};
}

std::string key_path(const SceneKey& key, std::size_t index) {
  switch (key.section) {
  case SceneSection::volume:
    return fmt::format("volume.{}.{}", index, key.name);
  case SceneSection::phase:
    return fmt::format("volume.{}.phase.{}", index, key.name);
  case SceneSection::emission:
    return fmt::format("volume.{}.emission.{}", index, key.name);
  case SceneSection::instance:
    return fmt::format("instance.{}.{}", index, key.name);
  case SceneSection::mesh:
    return fmt::format("mesh.{}.{}", index, key.name);
  case SceneSection::material:
    return fmt::format("mesh.{}.material.{}", index, key.name);
  case SceneSection::light:
    return fmt::format("light.{}.{}", index, key.name);
  case SceneSection::layer:
    return fmt::format("layer.{}.{}", index, key.name);
  default:
    return section_name(key.section) + "." + key.name;
  }
}

const SceneKey* type_key(SceneSection section) {
  return find_key(section, section == SceneSection::volume ? "shape" : "type");
}

bool takes_key(const Scene& scene, std::size_t index, const SceneKey& key) {
  if (key.types.empty())
    return true;
  const auto type = std::get<std::string>(type_key(key.section)->get(scene, index));
  return std::find(key.types.begin(), key.types.end(), type) != key.types.end();
}

std::size_t section_count(const Scene& scene, SceneSection section) {
  if (section == SceneSection::volume || section == SceneSection::phase ||
      section == SceneSection::emission)
    return scene.volumes.size();
  if (section == SceneSection::mesh || section == SceneSection::material)
    return scene.surfaces.size();
  if (section == SceneSection::instance)
    return scene.instances.size();
  if (section == SceneSection::layer)
    return scene.layers.size();
  return section == SceneSection::light ? scene.lights.size() : 1;
}

} // namespace vdbeam
