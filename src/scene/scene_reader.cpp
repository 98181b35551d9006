#include "scene/scene_reader.h"

#include "keys/key_synonyms.h"
#include "scene/animation.h"
#include "scene/toml_value.h"
#include "text/text.h"
#include "vdbeam/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace vdbeam {
namespace {

struct Child {
  std::string name;
  const toml::node* node;
};

/// A table's entries in the order of the file, so that the first mistake is reported first.
std::vector<Child> children_of(const toml::table& table) {
  std::vector<Child> children;
  for (const auto& [name, node] : table)
    children.push_back({std::string(name.str()), &node});
  std::stable_sort(children.begin(), children.end(), [](const Child& a, const Child& b) {
    return a.node->source().begin.line < b.node->source().begin.line;
  });
  return children;
}

const std::vector<std::pair<std::string, SceneSection>>& root_sections() {
  static const std::vector<std::pair<std::string, SceneSection>> sections{
      {"image", SceneSection::image},   {"camera", SceneSection::camera},
      {"volume", SceneSection::volume}, {"instance", SceneSection::instance},
      {"mesh", SceneSection::mesh},     {"light", SceneSection::light},
      {"layer", SceneSection::layer},   {"render", SceneSection::render},
  };
  return sections;
}

std::string item_name(SceneSection section, std::size_t index) {
  if (section == SceneSection::volume)
    return fmt::format("volume.{}", index);
  if (section == SceneSection::phase)
    return fmt::format("volume.{}.phase", index);
  if (section == SceneSection::emission)
    return fmt::format("volume.{}.emission", index);
  if (section == SceneSection::instance)
    return fmt::format("instance.{}", index);
  if (section == SceneSection::mesh)
    return fmt::format("mesh.{}", index);
  if (section == SceneSection::material)
    return fmt::format("mesh.{}.material", index);
  if (section == SceneSection::layer)
    return fmt::format("layer.{}", index);
  return section == SceneSection::light ? fmt::format("light.{}", index) : section_name(section);
}

/// Suggestion for an unknown key: what other programs call a key, a key of this
/// table, or one of another table.
std::string suggestion(SceneSection section, const std::string& name) {
  if (const std::string remedy = synonym_remedy(section, name); !remedy.empty())
    return remedy;
  if (const auto near = nearest_word(name, key_names(section)))
    return "; did you mean " + *near + "?";
  for (const SceneKey& key : scene_keys())
    if (key.name == name)
      return fmt::format("; {} is a key of {}", name, section_name(key.section));
  constexpr std::size_t few = 12;
  const std::vector<std::string> names = key_names(section);
  return names.size() <= few
             ? "; its keys are " + join_words(names, "and")
             : fmt::format("; vdbeam help scene {} lists its keys", section_name(section));
}

} // namespace

Scene SceneReader::read(const toml::table& root) {
  scene_.path = path_;
  for (const Child& child : children_of(root)) {
    const auto& sections = root_sections();
    const auto found = std::find_if(sections.begin(), sections.end(),
                                    [&](const auto& s) { return s.first == child.name; });
    if (found != sections.end()) {
      read_section(found->second, *child.node);
      continue;
    }
    std::vector<std::string> names;
    names.reserve(sections.size());
    for (const auto& [name, section] : sections)
      names.push_back(name);
    std::string hint = "; the tables are " + join_words(names, "and");
    if (const auto near = nearest_word(child.name, names))
      hint = "; did you mean " + *near + "?";
    for (const SceneKey& key : scene_keys())
      if (key.name == child.name && !key.is_list_item())
        hint = "; did you mean " + key_path(key, 0) + "?";
    throw InputError(
        one_line(fmt::format("{}: unknown key {}{}", location_of(*child.node), child.name, hint)));
  }
  place_instances();
  set_file_times();
  use_file_materials();
  add_suns();
  validate_consistency(scene_, [this](const std::string& key) { return locate(key); });
  note_idle_keys();
  return std::move(scene_);
}

/// Gives each atmosphere its sun, a light after all those of the file, so that these keep their
/// numbers.
void SceneReader::add_suns() {
  const std::size_t count = scene_.lights.size();
  for (std::size_t i = 0; i < count; ++i)
    if (LightSettings sun = scene_.lights[i]; sun.type == LightType::atmosphere && sun.sun) {
      sun.type = LightType::sun;
      scene_.lights.push_back(sun);
    }
}

/// Notes what is valid but probably a mistake.
void SceneReader::note_idle_keys() {
  if (scene_.camera.focal_length && locations_.contains("camera.fov"))
    scene_.notes.push_back(locate("camera.fov") +
                           ": camera.fov does nothing beside camera.focal_length");
  for (std::size_t i = 0; i < scene_.volumes.size(); ++i)
    for (const char* name : {"kelvin", "kelvin_offset", "reference", "law"}) {
      const SceneKey& key = *find_key(SceneSection::emission, name);
      const std::string path = key_path(key, i);
      // A file by vdbeam init has every key, with its default where it does not matter.
      if (scene_.volumes[i].emission.temperature.empty() && locations_.contains(path) &&
          key.format(key.get(scene_, i)) != key.default_text())
        scene_.notes.push_back(
            fmt::format("{}: {} does nothing without a temperature grid", locate(path), path));
    }
  note_units();
}

/// Reports values that are right in another unit than the key's.
void SceneReader::note_units() {
  const CameraSettings& camera = scene_.camera;
  // Nobody wants a picture of 1.6 degrees or less; half a turn is pi in radians.
  constexpr double narrow = 1.6, degrees = 180 / 3.14159265358979323846;
  if (camera.fov < narrow)
    scene_.notes.push_back(fmt::format("{}: camera.fov = {} is in degrees; if radians are meant, "
                                       "write {:.3g}",
                                       locate("camera.fov"), camera.fov, camera.fov * degrees));
  // No shutter is open for ten frames; 180 degrees are half a frame.
  constexpr double longest_shutter = 10, turn = 360;
  for (const auto& [name, value] : {std::pair("camera.shutter_open", camera.shutter_open),
                                    std::pair("camera.shutter_close", camera.shutter_close)})
    if (std::abs(value) > longest_shutter)
      scene_.notes.push_back(fmt::format("{}: {} = {} is in frames; if degrees are meant, write "
                                         "{:.3g}",
                                         locate(name), name, value, value / turn));
  constexpr double large_error = 0.1;
  if (const auto& error = scene_.render.target_error; error && *error >= large_error)
    scene_.notes.push_back(fmt::format("{}: render.target_error = {} is reached by almost any "
                                       "image after a few passes; a clean image has about 0.001",
                                       locate("render.target_error"), *error));
}

void SceneReader::read_section(SceneSection section, const toml::node& node) {
  if (section == SceneSection::volume || section == SceneSection::instance ||
      section == SceneSection::mesh || section == SceneSection::light ||
      section == SceneSection::layer)
    return read_list(section, node);
  if (const auto* table = node.as_table()) {
    read_table(section, 0, *table);
    if (section == SceneSection::camera)
      place_camera(*table);
    return;
  }
  throw InputError(fmt::format("{0}: {1} must be a table: write [{1}], got {2}", location_of(node),
                               section_name(section), node_text(node)));
}

void SceneReader::read_list(SceneSection section, const toml::node& node) {
  const std::string name = section_name(section);
  const auto* list = node.as_array();
  if (!list)
    throw InputError(fmt::format("{0}: {1} must be a list: write [[{1}]] for each {1}, got {2}",
                                 location_of(node), name, node_text(node)));
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto* table = (*list)[i].as_table();
    if (!table)
      throw InputError(fmt::format("{}: {}.{} must be a table, got {}", location_of((*list)[i]),
                                   name, i, node_text((*list)[i])));
    if (section == SceneSection::volume)
      scene_.volumes.emplace_back();
    else if (section == SceneSection::instance)
      scene_.instances.emplace_back();
    else if (section == SceneSection::mesh)
      scene_.surfaces.emplace_back();
    else if (section == SceneSection::layer)
      scene_.layers.emplace_back();
    else
      scene_.lights.emplace_back();
    read_table(section, i, *table);
  }
}

void SceneReader::read_table(SceneSection section, std::size_t index, const toml::table& table) {
  placement_.clear();
  if (section == SceneSection::volume) {
    time_.reset();
    if (const toml::node* node = table.get("time"))
      time_ = read_volume_time(*node, fmt::format("volume.{}.time", index), frame_.number);
  }
  for (const Child& child : children_of(table)) {
    const SceneKey* key = find_key(section, child.name);
    if (key)
      read_key(*key, index, *child.node);
    else if (section == SceneSection::volume && child.name == "phase")
      read_typed_part(SceneSection::phase, index, *child.node,
                      R"({ type = "henyey_greenstein", g = 0.6 })");
    else if (section == SceneSection::mesh && child.name == "material")
      read_typed_part(SceneSection::material, index, *child.node,
                      R"({ type = "diffuse", albedo = 0.8 })");
    else if (section == SceneSection::volume && child.name == "emission")
      read_emission(index, *child.node);
    else if (section == SceneSection::instance && child.name == "rows")
      read_rows(index, *child.node);
    else if (section == SceneSection::volume && child.name == "time")
      continue; // read before, since the file depends on it
    else
      fail_unknown(section, index, child.name, *child.node);
  }
  check_required(section, index, table);
  check_types(section, index, table);
  check_power(section, index, table);
  if (section == SceneSection::volume || section == SceneSection::mesh)
    place(section, index);
}

/// A table that may be written as the name of its type alone.
void SceneReader::read_typed_part(SceneSection section, std::size_t index, const toml::node& node,
                                  const char* example) {
  if (node.is_string())
    return read_key(*find_key(section, "type"), index, node);
  const auto* table = node.as_table();
  if (!table)
    throw InputError(fmt::format("{}: {} must be a table, e.g. {}, got {}", location_of(node),
                                 item_name(section, index), example, node_text(node)));
  read_part(section, index, *table);
}

void SceneReader::read_emission(std::size_t index, const toml::node& node) {
  const std::string path = fmt::format("volume.{}.emission", index);
  const auto* table = node.as_table();
  if (!table)
    throw InputError(
        fmt::format("{}: {} must be a table, e.g. {{ intensity = \"flame\", scale = 10 "
                    "}}, got {}",
                    location_of(node), path, node_text(node)));
  locations_[path] = location_of(node);
  read_part(SceneSection::emission, index, *table);
}

/// A table inside a volume's.
void SceneReader::read_part(SceneSection section, std::size_t index, const toml::table& table) {
  // read_table would forget the placement of the volume.
  const auto placement = placement_;
  read_table(section, index, table);
  placement_ = placement;
}

void SceneReader::read_key(const SceneKey& key, std::size_t index, const toml::node& node) {
  const std::string path = key_path(key, index);
  KeyValue value = read_value_at(key, path, node, frame_.time);
  locations_[path] = location_of(node);
  if (key.kind == KeyKind::file && !std::get<std::string>(value).empty())
    value = resolve_file(key, index, std::get<std::string>(value), node);
  if (key.set)
    key.set(scene_, index, value);
  else
    placement_[key.name] = std::get<std::vector<double>>(value);
}

void SceneReader::check_required(SceneSection section, std::size_t index,
                                 const toml::table& table) const {
  for (const SceneKey& key : scene_keys())
    if (key.section == section && key.required && takes_key(scene_, index, key) &&
        !table.contains(key.name))
      throw InputError(fmt::format("{}: {} needs {}: {}", location_of(table),
                                   item_name(section, index), key.name, key.doc));
}

void SceneReader::check_types(SceneSection section, std::size_t index,
                              const toml::table& table) const {
  const SceneKey* const kind = type_key(section);
  if (!kind)
    return;
  const std::string type = std::get<std::string>(kind->get(scene_, index));
  const toml::node* type_node = table.get(kind->name);
  const bool type_replaced = type_node && is_override(*type_node);
  for (const Child& child : children_of(table)) {
    const SceneKey* key = find_key(section, child.name);
    if (!key) // a table of its own
      continue;
    const bool fits = takes_key(scene_, index, *key);
    // The command line may change the type; what the file says for the old type is then moot.
    if (fits || (type_replaced && !is_override(*child.node)))
      continue;
    throw InputError(fmt::format("{}: {} does not belong to {} \"{}\", only to {}",
                                 location_of(*child.node), key_path(*key, index), kind->name, type,
                                 join_words(key->types, "and")));
  }
}

/// A lamp's strength is one number: its power, or what stands beside it in the tables.
void SceneReader::check_power(SceneSection section, std::size_t index,
                              const toml::table& table) const {
  const char* const other = section == SceneSection::light      ? "intensity"
                            : section == SceneSection::material ? "radiance"
                                                                : nullptr;
  const toml::node* const power = table.get("power");
  if (!other || !power || !table.contains(other))
    return;
  const SceneKey& key = *find_key(section, "power");
  const bool replaced = is_override(*power) && !is_override(*table.get(other));
  if (replaced || std::holds_alternative<std::monostate>(key.get(scene_, index)))
    return;
  throw InputError(fmt::format("{}: {} excludes {}: write one or the other", location_of(*power),
                               key_path(key, index), other));
}

/// Folds translate, rotate and scale into the transform of a volume or mesh.
void SceneReader::place(SceneSection section, std::size_t index) {
  if (placement_.empty())
    return;
  const std::string item = item_name(section, index), path = item + ".transform";
  if (locations_.contains(path))
    throw InputError(fmt::format("{}: {} excludes {}: write one or the other", locate(path), path,
                                 placement_.begin()->first));
  const auto get = [&](const char* name, double standard) {
    const auto found = placement_.find(name);
    return found == placement_.end() ? Vec3d(standard)
                                     : Vec3d(found->second[0], found->second[1], found->second[2]);
  };
  const Vec3d factors = get("scale", 1);
  if (factors.x * factors.y * factors.z == 0) {
    const std::string key = item + ".scale";
    throw InputError(fmt::format("{}: {} must not be 0 in any direction, got [{}, {}, {}]",
                                 locate(key), key, factors.x, factors.y, factors.z));
  }
  const Vec3d translate = get("translate", 0), angles = get("rotate", 0);
  std::array<double, 12>& m = section == SceneSection::volume ? scene_.volumes[index].transform
                                                              : scene_.surfaces[index].transform;
  m = placement_matrix({translate.x, translate.y, translate.z}, {angles.x, angles.y, angles.z},
                       {factors.x, factors.y, factors.z});
  for (const char* name : {"scale", "rotate", "translate"})
    if (const auto key = locations_.find(item + "." + name); key != locations_.end()) {
      locations_[path] = key->second;
      break;
    }
}

std::string SceneReader::locate(const std::string& key) const {
  const auto found = locations_.find(key);
  return found == locations_.end() ? path_ : found->second;
}

void SceneReader::fail_unknown(SceneSection section, std::size_t index, const std::string& name,
                               const toml::node& node) const {
  throw InputError(
      one_line(fmt::format("{}: unknown key {}.{}{}", location_of(node), item_name(section, index),
                           name, suggestion(section, name))));
}

} // namespace vdbeam
