#include "keys/scene_keys.h"
#include "scene/default_scene.h"
#include "text/printable.h"
#include "vdbeam/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

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

class Writer {
public:
  Writer(const Scene& scene, std::string file) : scene_(scene), file_(std::move(file)) {}

  std::string write() {
    text_ =
        "# A vdbeam scene. docs/reference/scene.md and `vdbeam --help-scene` explain every key;\n"
        "# commented lines show the defaults.\n";
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
    add_section(SceneSection::render, 0, "[render]");
    return text_;
  }

private:
  void add_section(SceneSection section, std::size_t index, const std::string& header) {
    text_ += "\n" + header + "\n";
    for (const SceneKey& key : scene_keys())
      if (key.section == section && takes_key(scene_, index, key))
        text_ += line(key, index);
  }

  std::string line(const SceneKey& key, std::size_t index) const {
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
    return fmt::format("{:<40}# {}{}\n",
                       fmt::format("{}{} = {}", written ? "" : "# ", key.name, text) + " ", key.doc,
                       unit);
  }

  /// A table inside a volume's, in one line.
  std::string part_line(SceneSection section, const char* name, std::size_t index) const {
    std::string items;
    for (const SceneKey& key : scene_keys())
      if (key.section == section && takes_key(scene_, index, key))
        items += fmt::format("{}{} = {}", items.empty() ? "" : ", ", key.name,
                             key.kind == KeyKind::text
                                 ? quote(std::get<std::string>(key.get(scene_, index)))
                                 : key.format(key.get(scene_, index)));
    return fmt::format("{} = {{ {} }}\n", name, items);
  }

  const Scene& scene_;
  std::string file_;
  std::string text_;
};

} // namespace

std::string scene_text(const Scene& scene, const std::string& file) {
  return Writer(scene, file).write();
}

std::string scene_template(const std::string& vdb_path, const std::string& folder) {
  namespace fs = std::filesystem;
  const Scene scene = make_default_scene(vdb_path, {});
  std::error_code error;
  const fs::path base = fs::absolute(folder.empty() ? fs::path(".") : fs::path(folder), error);
  const fs::path relative =
      fs::absolute(vdb_path, error).lexically_normal().lexically_relative(base.lexically_normal());
  return scene_text(scene, relative.empty() ? vdb_path : relative.string());
}

} // namespace vdbeam
