#include "keys/scene_keys.h"
#include "scene/default_scene.h"
#include "text/printable.h"
#include "vdbeam/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace vdbeam {
namespace {

/// A TOML basic string, which is UTF-8.
std::string quote(const std::string& text) {
  std::string result = "\"";
  for (const char c : as_utf8(text)) {
    if (c == '"' || c == '\\')
      result += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + "\"";
}

/// The keys that are changed first in a new scene; the template shows them even where they have
/// their defaults.
bool comes_first(const SceneKey& key) {
  static const std::map<SceneSection, std::vector<std::string>> names{
      {SceneSection::image, {"width", "height"}},
      {SceneSection::camera, {"position", "look_at", "up", "fov"}},
      {SceneSection::volume, {"file", "density", "extinction", "albedo"}},
      {SceneSection::light, {"type", "direction", "irradiance", "radiance", "exposure"}},
      {SceneSection::render, {"passes", "time", "target_error"}}};
  const auto found = names.find(key.section);
  return found != names.end() &&
         std::find(found->second.begin(), found->second.end(), key.name) != found->second.end();
}

constexpr const char* other_tables = R"(
# [[mesh]]                              # a ground; type = "file" and file = "prop.obj" read a mesh
# type = "plane"
# rotate = [{}, 0, 0]
# translate = [0, 0, 0]
# material = {{ type = "diffuse", albedo = 0.3 }}

# [[layer]]                             # without [[layer]] all usual layers are written, else only these
# name = "alpha"
)";

class Writer {
public:
  Writer(const Scene& scene, std::string file, bool all_keys)
      : scene_(scene), file_(std::move(file)), all_keys_(all_keys) {}

  std::string write() {
    text_ = "# A vdbeam scene. docs/reference/scene.md and `vdbeam help scene` explain every key;\n"
            "# commented lines show the defaults.";
    text_ += all_keys_ ? "\n" : " `vdbeam init --all` writes all keys.\n";
    add_section(SceneSection::image, 0, "[image]");
    add_section(SceneSection::camera, 0, "[camera]");
    for (std::size_t i = 0; i < scene_.volumes.size(); ++i) {
      add_section(SceneSection::volume, i, "[[volume]]");
      text_ += part_line(SceneSection::phase, "phase", i);
      text_ += scene_.glows()
                   ? part_line(SceneSection::emission, "emission", i)
                   : "# emission = { intensity = \"flame\", scale = 10 }  # where a grid "
                     "glows\n";
    }
    for (std::size_t i = 0; i < scene_.lights.size(); ++i)
      add_section(SceneSection::light, i, "[[light]]");
    text_ += fmt::format(other_tables, scene_.camera.up.z > 0.5 ? 0 : -90);
    add_section(SceneSection::render, 0, "[render]");
    return text_;
  }

private:
  void add_section(SceneSection section, std::size_t index, const std::string& header) {
    text_ += "\n" + header + "\n";
    for (const SceneKey& key : scene_keys())
      if (key.section == section && takes_key(scene_, index, key))
        if (const Line line = make_line(key, index); all_keys_ || line.written || comes_first(key))
          text_ += line.text;
  }

  struct Line {
    std::string text;
    bool written; ///< not commented out
  };

  Line make_line(const SceneKey& key, std::size_t index) const {
    KeyValue value = key.get ? key.get(scene_, index) : KeyValue{};
    if (key.section == SceneSection::render && key.name == "passes" &&
        std::holds_alternative<std::monostate>(value))
      value = std::int64_t{64};
    const bool absent = std::holds_alternative<std::monostate>(value);
    std::string text = absent ? key.default_text() : key.format(value);
    const bool as_default = text == key.default_text();
    if (key.section == SceneSection::volume && key.name == "file")
      text = quote(file_);
    else if (key.kind == KeyKind::text || key.kind == KeyKind::file)
      text = quote(std::get<std::string>(value));
    else if (absent && key.absent_word.empty() && key.get) // inherited: show how it would be set
      text = quote(key.choices.front());
    const bool written = !absent && (!as_default || key.required || key.always_written);
    const std::string unit = key.unit.empty() ? "" : " [" + key.unit + "]";
    return {fmt::format("{:<40}# {}{}\n",
                        fmt::format("{}{} = {}", written ? "" : "# ", key.name, text) + " ",
                        key.doc, unit),
            written};
  }

  /// A table inside a volume's, in one line.
  std::string part_line(SceneSection section, const char* name, std::size_t index) const {
    std::string items;
    for (const SceneKey& key : scene_keys())
      if (key.section == section && takes_key(scene_, index, key) &&
          (all_keys_ || key.format(key.get(scene_, index)) != key.default_text()))
        items += fmt::format("{}{} = {}", items.empty() ? "" : ", ", key.name,
                             key.kind == KeyKind::text
                                 ? quote(std::get<std::string>(key.get(scene_, index)))
                                 : key.format(key.get(scene_, index)));
    return fmt::format("{} = {{ {} }}\n", name, items);
  }

  const Scene& scene_;
  std::string file_;
  bool all_keys_;
  std::string text_;
};

} // namespace

std::string scene_text(const Scene& scene, const std::string& file, bool all_keys) {
  return Writer(scene, file, all_keys).write();
}

std::string scene_template(const std::string& vdb_path, const std::string& folder, bool all_keys) {
  namespace fs = std::filesystem;
  const Scene scene = make_default_scene(vdb_path, {});
  std::error_code error;
  const fs::path base = fs::absolute(folder.empty() ? fs::path(".") : fs::path(folder), error);
  const fs::path relative =
      fs::absolute(vdb_path, error).lexically_normal().lexically_relative(base.lexically_normal());
  return scene_text(scene, relative.empty() ? vdb_path : relative.string(), all_keys);
}

} // namespace vdbeam
