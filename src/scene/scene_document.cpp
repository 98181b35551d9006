#include "scene/scene_document.h"

#include "geometry/gltf/gltf_files.h"
#include "lights/light_table.h"
#include "machine/input_file.h"
#include "materials/material_table.h"
#include "scene/default_scene.h"
#include "scene/scene_reader.h"
#include "scene/shutter.h"
#include "scene/toml_nesting.h"
#include "scene/toml_remedy.h"
#include "scene/toml_value.h"
#include "text/frame_range.h"
#include "text/missing_file.h"
#include "text/text.h"
#include "vdbeam/error.h"
#include "vdbeam/scene_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>

namespace vdbeam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_scene_file = 16u << 20;

std::string read_scene_text(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error))
    throw InputError(one_line(fmt::format("{}: is a folder, not a scene file or VDB", path)));
  if (fs::is_character_file(path, error))
    throw InputError(one_line(path + ": is a device, not a scene file or VDB"));
  std::string text = read_text(path, longest_scene_file);
  for (const auto& [magic, kind] :
       {std::pair("\x76\x2f\x31\x01", "an OpenEXR image"), std::pair("\x89PNG", "a PNG image"),
        std::pair("\xff\xd8\xff", "a JPEG image"), std::pair("#?RADIANCE", "a Radiance image")})
    if (text.starts_with(magic))
      throw InputError(one_line(fmt::format("{}: is {}, not a scene file or VDB", path, kind)));
  return text;
}

toml::table parse_toml(const std::string& text, const std::string& path) {
  check_nesting(text, path);
  try {
    return toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    std::string reason(error.description());
    // "Error while parsing key-value pair: cannot redefine ..." needs only its second half.
    if (const auto colon = reason.find(": ");
        reason.starts_with("Error while") && colon < reason.size())
      reason.erase(0, colon + 2);
    const std::string line =
        one_line(fmt::format("{}:{}: not valid TOML: {}", path, error.source().begin.line, reason));
    throw InputError(line + toml_remedy(reason, text, error.source().begin.line));
  }
}

/// The value of a key of a tree that is not checked yet, where it is a plain number or list of
/// three.
template <class T>
std::optional<T> peek(const toml::table& root, const char* path) {
  return root.at_path(path).value<T>();
}

/// The settings of the default scene that the command line overrides.
FramingWishes wishes_of(const std::vector<Override>& overrides) {
  toml::table root;
  root.insert("volume", toml::array{toml::table{}});
  for (const Override& entry : overrides)
    if (entry.key.starts_with("camera.up") || entry.key.starts_with("image.") ||
        entry.key == "volume.0.density" || entry.key == "volume.density")
      apply_override(root, entry);
  FramingWishes wishes;
  wishes.width = peek<int>(root, "image.width");
  wishes.height = peek<int>(root, "image.height");
  wishes.grid = peek<std::string>(root, "volume[0].density");
  const auto up = root.at_path("camera.up");
  if (up.is_array() && up.as_array()->size() == 3) {
    const Vec3d axis(up[0].value_or(0.), up[1].value_or(0.), up[2].value_or(0.));
    if (length(axis) > 0)
      wishes.up = normalize(axis);
  }
  return wishes;
}

/// Whether a value of the scene changes from frame to frame.
bool is_animated(const toml::node& node) {
  bool animated = false;
  if (const toml::array* list = node.as_array())
    for (const toml::node& item : *list)
      animated = animated || is_animated(item);
  if (const toml::table* table = node.as_table())
    for (const auto& [name, value] : *table)
      animated = animated || name == "keys" || is_animated(value);
  return animated;
}

/// Whether a list like "a, b" has this name.
bool lists(const std::string& list, const std::string& name) {
  std::string bare = list;
  std::erase(bare, ' ');
  return ("," + bare + ",").find("," + name + ",") != std::string::npos;
}

/// Calls visit(key, index, path) for each file of a frame's scene.
template <class Visit>
void for_each_file(const Scene& scene, const Visit& visit) {
  for (const SceneKey& key : scene_keys())
    for (std::size_t i = 0; key.kind == KeyKind::file && i < section_count(scene, key.section); ++i)
      if (const std::string path = std::get<std::string>(key.get(scene, i)); !path.empty())
        visit(key, i, path);
}

/// The camera moves and all that it sees stands still: photons can serve many frames
/// (docs/how-to/sequences.md) if they do not depend on the view.
bool only_camera_moves(const toml::table& root) {
  bool camera = false, others = false;
  for (const auto& [name, section] : root)
    (name == "camera" ? camera : others) |= is_animated(section);
  camera = camera || root.at_path("camera.file");
  return camera && !others;
}

/// A mesh's own file moves it.
bool files_move(const Scene& scene) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [](const SurfaceSettings& s) { return s.file_seconds.has_value(); });
}

/// A picture with nothing behind the medium is an element for compositing, which needs its A.
void note_lost_alpha(Scene& scene) {
  if (scene.layers.empty())
    return;
  const bool alpha = std::any_of(scene.layers.begin(), scene.layers.end(),
                                 [](const LayerSettings& layer) { return layer.name == "alpha"; });
  const bool sky =
      std::any_of(scene.lights.begin(), scene.lights.end(), [](const LightSettings& light) {
        return light_kind(light.type).surrounds && light.visible;
      });
  if (!alpha && !sky)
    scene.notes.push_back(
        scene.path +
        ": the image will have no alpha, since no [[layer]] is \"alpha\"; add one for compositing");
}

/// Whether a text of the tree holds a frame number's place.
bool names_frames(const toml::node& node) {
  bool found = false;
  if (const toml::array* list = node.as_array())
    for (const toml::node& item : *list)
      found = found || names_frames(item);
  if (const toml::table* table = node.as_table())
    for (const auto& [name, value] : *table)
      found = found || names_frames(value);
  if (const auto* text = node.as_string())
    found = has_frame_pattern(text->get());
  return found;
}

} // namespace

bool is_vdb_file(const std::string& path) {
  const std::string extension = lower_case(fs::path(path).extension().string());
  if (extension == ".vdb")
    return true;
  try {
    return read_start(path, 4) == " BDV";
  } catch (const Error&) {
    return false;
  }
}

SceneDocument::SceneDocument(const std::string& path, const std::vector<Override>& overrides)
    : path_(path), folder_(fs::path(path).parent_path()) {
  if (!is_there(path) && vdbeam::frames_on_disk(path).empty())
    throw InputError(missing_file_text(path));
  if (is_vdb_file(path)) {
    const Scene scene = make_default_scene(path, wishes_of(overrides));
    notes_ = scene.notes;
    root_ = parse_toml(scene_text(scene, fs::path(path).filename().string()),
                       path + " (default scene)");
    // The path itself need not be UTF-8, which TOML is.
    if (auto* file = root_.at_path("volume[0].file").as_string())
      *file = fs::path(path).filename().string();
  } else {
    root_ = parse_toml(read_scene_text(path), path);
  }
  for (const Override& entry : overrides)
    apply_override(root_, entry);
}

SceneDocument::SceneDocument(const std::string& text, const std::string& path,
                             const std::vector<Override>& overrides)
    : path_(path), folder_(fs::path(path).parent_path()), root_(parse_toml(text, path)) {
  for (const Override& entry : overrides)
    apply_override(root_, entry);
}

Scene SceneDocument::scene_at(const FrameTime& frame, MissingFile missing) const {
  const auto at = [&](const FrameTime& moment) {
    return SceneReader(path_, folder_, *camera_file_, moment, missing).read(root_);
  };
  Scene scene = at(frame);
  check_named_files(scene);
  add_moments(scene, is_animated(root_) || !scene.camera.file.empty() || files_move(scene),
              [&](double time) { return at(FrameTime(frame.number, time)); });
  scene.notes.insert(scene.notes.begin(), notes_.begin(), notes_.end());
  note_lost_alpha(scene);
  if (scene.render.thinning == PhotonThinning::automatic && only_camera_moves(root_) &&
      !has_frame_pattern() && !files_move(scene))
    scene.render.thinning = PhotonThinning::even;
  constexpr int usual_passes = 64;
  if (!scene.render.passes && !scene.render.time && !scene.render.target_error)
    scene.render.passes = usual_passes;
  if (scene.volumes.empty())
    scene.notes.push_back(path_ + ": there is no [[volume]]: only lights are rendered");
  const bool shining = std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                                   [](const SurfaceSettings& s) { return shines(s.material); });
  if (scene.lights.empty() && !scene.glows() && !shining)
    scene.notes.push_back(path_ + ": there is no [[light]]: the image will be black");
  for (Scene& moment : scene.moments)
    moment.render = scene.render;
  return scene;
}

std::vector<SceneFile> SceneDocument::files() const {
  return scene_files(root_, folder_);
}

std::string SceneDocument::where(const std::string& key) const {
  for (const SceneFile& file : files())
    if (file.key == key)
      return fmt::format("{}: {}: ", file.location, key);
  return "";
}

/// Checks the files that the scene's files name; the scene's own were checked as they were read.
void SceneDocument::check_named_files(const Scene& scene) const {
  for_each_file(scene, [&](const SceneKey& key, std::size_t index, const std::string& path) {
    try {
      check_named_inputs(key.input, path);
    } catch (const InputError& error) {
      throw InputError(where(key_path(key, index)) + error.what());
    }
  });
}

std::string SceneDocument::who_names(std::size_t volume, const std::string& line) const {
  const std::size_t begin = line.find('"'), end = line.find('"', begin + 1);
  const auto* list = root_.get_as<toml::array>("volume");
  const auto* table = list && volume < list->size() ? (*list)[volume].as_table() : nullptr;
  if (end == std::string::npos || !table)
    return "";
  const std::string grid = line.substr(begin + 1, end - begin - 1);
  for (const char* key : {"density", "velocity", "color_grid", "add", "mask", "emission.intensity",
                          "emission.temperature"}) {
    const toml::node* node = table->at_path(key).node();
    const auto* text = node ? node->as_string() : nullptr;
    if (!text || !(text->get() == grid || lists(text->get(), grid)))
      continue;
    const std::string location = location_of(*node);
    // In the scene that a bare VDB gets by default nobody wrote the key.
    return is_vdb_file(path_) && location.starts_with(path_)
               ? ""
               : fmt::format("{}: volume.{}.{}: ", location, volume, key);
  }
  return "";
}

std::string SceneDocument::whose_file(const Scene& scene, const std::string& line) const {
  std::string whose, grid;
  for_each_file(scene, [&](const SceneKey& key, std::size_t index, const std::string& path) {
    if (!whose.empty() || !line.starts_with(path + ":"))
      return;
    whose = key_path(key, index);
    if (key.input == InputKind::volume)
      grid = who_names(index, line.substr(path.size() + 1));
  });
  if (!grid.empty())
    return grid;
  return is_vdb_file(path_) ? "" : where(whose);
}

std::string SceneDocument::first_pattern() const {
  for (const SceneFile& file : files())
    if (file.input != InputKind::camera && vdbeam::has_frame_pattern(file.pattern))
      return file.pattern;
  return "";
}

bool SceneDocument::depends_on_frame() const {
  const auto moves = [](const SceneFile& file) {
    return file.input == InputKind::mesh && is_animated_gltf(file.pattern);
  };
  const std::vector<SceneFile> named = files();
  return is_animated(root_) || names_frames(root_) || root_.at_path("camera.file") ||
         std::any_of(named.begin(), named.end(), moves);
}

bool SceneDocument::has_frame_pattern() const {
  return !first_pattern().empty();
}

std::vector<int> SceneDocument::frames_on_disk() const {
  return vdbeam::frames_on_disk(first_pattern());
}

namespace {

std::vector<Override> parse_overrides(const std::vector<std::string>& overrides) {
  std::vector<Override> entries;
  entries.reserve(overrides.size());
  for (const std::string& text : overrides)
    entries.push_back(parse_override(text));
  return entries;
}

} // namespace

Scene load_scene(const std::string& path, const FrameTime& frame,
                 const std::vector<std::string>& overrides) {
  return SceneDocument(path, parse_overrides(overrides)).scene_at(frame);
}

Scene parse_scene(const std::string& text, const std::string& path, const FrameTime& frame,
                  const std::vector<std::string>& overrides) {
  return SceneDocument(text, path, parse_overrides(overrides)).scene_at(frame);
}

} // namespace vdbeam
