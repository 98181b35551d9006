#include "geometry/gltf/gltf_files.h"
#include "layers/plane_layers.h"
#include "machine/input_file.h"
#include "scene/content_hash.h"
#include "scene/scene_inputs.h"
#include "vdbeam/scene_file.h"

#include <bit>
#include <fmt/format.h>

namespace vdbeam {
namespace {

void add(ContentHash& hash, const std::string& text) {
  hash.add_number(text.size());
  hash.add(text.data(), text.size());
}

/// Numbers enter by their bits: text would round colours and depend on the library's formatting.
void add(ContentHash& hash, const KeyValue& value) {
  hash.add_number(value.index());
  if (const auto* whole = std::get_if<std::int64_t>(&value))
    hash.add_number(static_cast<std::uint64_t>(*whole));
  else if (const auto* number = std::get_if<double>(&value))
    hash.add_number(std::bit_cast<std::uint64_t>(*number + 0.0));
  else if (const auto* text = std::get_if<std::string>(&value))
    add(hash, *text);
  else if (const auto* list = std::get_if<std::vector<double>>(&value))
    for (const double x : *list)
      hash.add_number(std::bit_cast<std::uint64_t>(x + 0.0)); // -0 is 0
}

/// A file with those that it names.
void add_file(ContentHash& hash, InputKind kind, const std::string& path) {
  check_input(kind, path);
  hash.add_number(hash_file(path));
  for (const std::string& file : gltf_files(path))
    if (is_there(file)) // a picture that no mesh needs may be missing
      hash.add_number(hash_file(file));
}

/// Adds the times of the animations of mesh files.
void add_file_times(ContentHash& hash, const Scene& scene) {
  for (const SurfaceSettings& surface : scene.surfaces)
    if (surface.file_seconds)
      hash.add_number(std::bit_cast<std::uint64_t>(*surface.file_seconds + 0.0));
}

/// Adds the scenes of other motion samples; their files are those of the scene itself.
void add_moments(ContentHash& hash, const std::vector<Scene>& moments) {
  for (const Scene& moment : moments)
    add_file_times(hash, moment);
  for (const Scene& moment : moments)
    for (const SceneKey& key : scene_keys())
      for (std::size_t i = 0; key.get && key.changes_picture && key.changes_passes &&
                              key.kind != KeyKind::file && i < section_count(moment, key.section);
           ++i)
        add(hash, key.get(moment, i));
}

/// Hash of everything that the image depends on, or that its passes depend on.
std::string hash_scene(const Scene& scene, bool of_passes) {
  ContentHash hash;
  for (const SceneKey& key : scene_keys()) {
    if (!key.get || !key.changes_picture || (of_passes && !key.changes_passes))
      continue;
    for (std::size_t i = 0; i < section_count(scene, key.section); ++i) {
      add(hash, key_path(key, i));
      const KeyValue value = key.get(scene, i);
      const bool absent =
          key.section == SceneSection::volume && !scene.volumes[i].present; // and so is its file
      if (absent)
        hash.add_number(0);
      else if (key.kind == KeyKind::file && !std::get<std::string>(value).empty())
        add_file(hash, key.input, std::get<std::string>(value));
      else
        add(hash, value);
    }
  }
  add_file_times(hash, scene);
  add_moments(hash, scene.moments);
  add_moments(hash, scene.next);
  for (const std::string& plane : plane_names(scene)) // that passes hold for layers
    add(hash, plane);
  return fmt::format("{:016x}", hash.value());
}

} // namespace

std::string scene_hash(const Scene& scene) {
  return hash_scene(scene, false);
}

std::string pass_hash(const Scene& scene) {
  return hash_scene(scene, true);
}

} // namespace vdbeam
