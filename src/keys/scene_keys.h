#pragma once

#include "vdbeam/scene.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vdbeam {

/// The tables of a scene file.
enum class SceneSection {
  image,
  camera,
  volume,
  phase,
  emission,
  instance,
  mesh,
  material,
  light,
  layer,
  render
};

/// Type of a key's value in the file.
enum class KeyKind {
  boolean,
  integer,
  number,
  text,
  file,
  choice,
  vector,
  color,
  duration,
  matrix
};

/// Kind of file that a key of the kind `file` names.
enum class InputKind { none, volume, picture, mesh, camera, profile, instances };

/// A value between the file and the settings: absent ("auto", "none"), a whole number (also for a
/// boolean), a number, a text or choice, or a list of numbers.
using KeyValue =
    std::variant<std::monostate, std::int64_t, double, std::string, std::vector<double>>;

/// Where a number, or each number of a list, must lie.
struct NumberRange {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false, upper_open = false;

  bool contains(double x) const;
  /// "must lie in (-1, 1)", "must be at least 1"; empty where every number is right.
  std::string requirement() const;
  /// "(-1, 1)", ">= 1", "any".
  std::string text() const;
};

/// One key of a scene file. This table drives reading, validation, suggestions, help, the scene's
/// hash, the report's settings and the reference in docs/reference/scene.md.
struct SceneKey {
  SceneSection section;
  std::string name;
  KeyKind kind;
  InputKind input = InputKind::none; ///< of the kind `file`: which files
  std::string unit;
  NumberRange range;
  std::vector<std::string> choices;
  std::vector<std::string> choice_docs; ///< one clause for each choice, or empty
  std::string absent_word; ///< how "no value" is written ("auto", "none"); empty where it cannot be
  std::string doc;         ///< one clause
  std::vector<std::string> types; ///< of its section that take this key; empty: all
  bool required = false;
  std::vector<std::string> estimators; ///< that read this key; empty: all
  bool changes_picture = true;
  bool changes_passes = true;   ///< a pass depends on it, and not only when a frame ends
  bool advanced = false;        ///< its default suits nearly all scenes: listed after the others
  bool always_written = false;  ///< vdbeam init writes it also where it is as by default
  bool changes_world = true;    ///< a world must be built anew for another value
  bool scales_emission = false; ///< a factor of emission: its field need not be read anew
  bool one_for_all = false;     ///< a list of three may be written as one number
  /// The value in a scene; `index` counts volumes or lights. Empty for keys that are only another
  /// way to write `volume.transform`.
  std::function<KeyValue(const Scene&, std::size_t index)> get;
  std::function<void(Scene&, std::size_t index, const KeyValue&)> set;

  bool is_list_item() const {
    return section == SceneSection::volume || section == SceneSection::phase ||
           section == SceneSection::emission || section == SceneSection::instance ||
           section == SceneSection::mesh || section == SceneSection::material ||
           section == SceneSection::light || section == SceneSection::layer;
  }
  /// What is wrong with a value ("must lie in (-1, 1), got 1.2"), or nothing.
  std::optional<std::string> complaint(const KeyValue& value) const;
  /// The value as it would be written in a scene file.
  std::string format(const KeyValue& value) const;
  std::string default_text() const;
  /// "whole number", "3 numbers", ...
  std::string kind_text() const;
};

/// All keys, in the order of the sections above.
const std::vector<SceneKey>& scene_keys();

/// The key, or null.
const SceneKey* find_key(SceneSection section, const std::string& name);

/// Names of the keys of a section.
std::vector<std::string> key_names(SceneSection section);

/// "image", "camera", "volume", "volume.phase", "volume.emission", "instance", "mesh",
/// "mesh.material", "light", "layer", "render".
std::string section_name(SceneSection section);
/// The path of one key in a scene, e.g. "volume.0.phase.g".
std::string key_path(const SceneKey& key, std::size_t index);
/// The key that says what a table of the section is, and so which other keys it takes: `type`, of
/// volumes `shape`; null where there is none.
const SceneKey* type_key(SceneSection section);
/// Whether the section's table of this index, as it is, takes the key.
bool takes_key(const Scene& scene, std::size_t index, const SceneKey& key);
/// How many times the section is there in a scene.
std::size_t section_count(const Scene& scene, SceneSection section);

/// The reference table of a section, as in docs/reference/scene.md (Markdown).
std::string key_table_markdown(SceneSection section);
/// The same for a terminal, in lines of at most `width` columns.
std::string key_table_text(SceneSection section, std::size_t width);
/// All sections one after the other.
std::string key_tables_text(std::size_t width);
/// All tables, in the order of the sections above.
const std::vector<SceneSection>& scene_sections();

} // namespace vdbeam
