#include "keys/scene_keys.h"
#include "text/text.h"
#include "text/wrap.h"

#include <fmt/format.h>

namespace vdbeam {
namespace {

/// Values that a key takes: its choices, or its kind and range.
std::string values_text(const SceneKey& key, const char* quote) {
  if (key.kind == KeyKind::choice) {
    std::string text;
    for (const std::string& choice : key.choices)
      text += fmt::format("{}{}\"{}\"{}", text.empty() ? "" : ", ", quote, choice, quote);
    return text;
  }
  std::string text = key.kind == KeyKind::boolean    ? "true or false"
                     : key.kind == KeyKind::integer  ? "whole number"
                     : key.kind == KeyKind::number   ? "number"
                     : key.kind == KeyKind::text     ? "text"
                     : key.kind == KeyKind::file     ? "path"
                     : key.kind == KeyKind::vector   ? "3 numbers"
                     : key.kind == KeyKind::color    ? "RGB"
                     : key.kind == KeyKind::duration ? "duration"
                                                     : "12 numbers";
  const std::string range = key.range.text();
  if (range != "any" && key.kind != KeyKind::boolean)
    text += (range.front() == '>' ? " " : " in ") + range;
  return text;
}

/// "distant and spot: " for a key that only they take, "" for one that all take.
std::string owners(const SceneKey& key) {
  const std::vector<std::string>& names = key.types.empty() ? key.estimators : key.types;
  return names.empty() ? "" : join_words(names, "and") + ": ";
}

/// "; `beam`: the beam radiance estimate ..." for choices that have a clause each.
std::string choices_text(const SceneKey& key) {
  std::string text;
  for (std::size_t i = 0; i < key.choice_docs.size(); ++i)
    text += fmt::format("; `{}`: {}", key.choices[i], key.choice_docs[i]);
  return text;
}

constexpr const char* advanced_title = "Advanced keys; the defaults suit nearly all scenes";

std::vector<const SceneKey*> keys_of(SceneSection section, bool advanced) {
  std::vector<const SceneKey*> keys;
  for (const SceneKey& key : scene_keys())
    if (key.section == section && key.advanced == advanced)
      keys.push_back(&key);
  return keys;
}

/// A key's meaning, values and choices, for a terminal.
std::string key_text(const SceneKey& key, std::size_t width) {
  constexpr std::size_t indent = 21;
  const std::string unit = key.unit.empty() ? "" : " [" + key.unit + "]";
  std::string text = two_columns(key.name, owners(key) + key.doc, indent, width);
  text += two_columns("",
                      fmt::format("{}{}, {}{}", values_text(key, ""), unit,
                                  key.required ? "" : "default ", key.default_text()),
                      indent, width);
  for (std::size_t i = 0; i < key.choice_docs.size(); ++i)
    text +=
        two_columns("", fmt::format("{}: {}", key.choices[i], key.choice_docs[i]), indent, width);
  return text;
}

} // namespace

std::string key_table_markdown(SceneSection section) {
  std::string text;
  for (const bool advanced : {false, true}) {
    const std::vector<const SceneKey*> keys = keys_of(section, advanced);
    if (keys.empty())
      continue;
    if (advanced)
      text += fmt::format("\n{}:\n\n", advanced_title);
    text += "| key | values | unit | default | meaning |\n|---|---|---|---|---|\n";
    for (const SceneKey* key : keys) {
      const std::string standard =
          key->required ? "required" : fmt::format("`{}`", key->default_text());
      text += fmt::format("| `{}` | {} | {} | {} | {}{}{} |\n", key->name, values_text(*key, "`"),
                          key->unit, standard, owners(*key), key->doc, choices_text(*key));
    }
  }
  return text;
}

const std::vector<SceneSection>& scene_sections() {
  static const std::vector<SceneSection> sections{
      SceneSection::image,    SceneSection::camera,   SceneSection::volume, SceneSection::phase,
      SceneSection::emission, SceneSection::instance, SceneSection::mesh,   SceneSection::material,
      SceneSection::light,    SceneSection::layer,    SceneSection::render};
  return sections;
}

std::string key_table_text(SceneSection section, std::size_t width) {
  std::string text = section_name(section) + "\n";
  for (const SceneKey* key : keys_of(section, false))
    text += key_text(*key, width);
  const std::vector<const SceneKey*> advanced = keys_of(section, true);
  if (!advanced.empty())
    text += fmt::format("\n{}: {}\n", section_name(section), lower_case(advanced_title));
  for (const SceneKey* key : advanced)
    text += key_text(*key, width);
  return text;
}

std::string key_tables_text(std::size_t width) {
  std::string text;
  for (const SceneSection section : scene_sections()) {
    if (!text.empty())
      text += '\n';
    text += key_table_text(section, width);
  }
  return text;
}

} // namespace vdbeam
